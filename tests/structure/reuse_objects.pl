#!/usr/bin/perl
# Lets the build of a copy of the sources take objects of the build that the copy was made in.
#
#   reuse_objects.pl --record BUILD SOURCE COPY_BUILD COPY_SOURCE RECORDS
#       writes down which objects BUILD has of SOURCE (of Ninja, with compile_commands.json)
#   reuse_objects.pl RECORDS COMPILER ARGUMENT...
#       a compiler launcher for COPY_BUILD
#
# The launcher copies the object that has the same path in BUILD, where the commands are equal but for the folders, and
# compiles otherwise. Recorded are objects that are newer than every file that they depend on. Three kinds of flags may
# differ: -Werror, those of precompiled headers, which change no object, and the list of instruction sets
# (-DSHOAL_BUILDS_...) where none of the object's files names it.
# Where the folder RECORDS is gone the launcher compiles. The caller sees to it that the files are equal.
use strict;
use warnings;
use File::Basename qw(dirname);
use File::Copy qw(copy);
use File::Path qw(make_path);
use JSON::PP;
use Text::ParseWords qw(shellwords);

sub slurp {
  open my $file, "<", $_[0] or return "";
  local $/;
  return <$file> // "";
}

sub spill {
  my ($path, @text) = @_;
  open my $file, ">", $path or die "$path: $!\n";
  print $file @text;
  close $file or die "$path: $!\n";
}

sub record_of { my ($records, $object) = @_; return "$records/" . ($object =~ s{/}{!}gr) }

# A compiler's words without what may differ, on one line.
sub comparable {
  my ($build, $source, $names_isas, @words) = @_;
  my @kept;
  while (@words) {
    my $word = shift @words;
    if ($word eq "-MT" || $word eq "-MF" || $word eq "-include") { shift @words; next }
    next if $word eq "-Winvalid-pch" || $word eq "-MD" || $word eq "-Werror" || (!$names_isas && $word =~ /^-DSHOAL_BUILDS_/);
    push @kept, $word =~ s{\Q$build\E}{<build>}gr =~ s{\Q$source\E}{<source>}gr;
  }
  return join "\t", @kept;
}

# The word after an option; undefined where there is none.
sub value_of {
  my ($option, @words) = @_;
  for (0 .. $#words - 1) { return $words[$_ + 1] if $words[$_] eq $option }
  return undef;
}

sub record {
  my ($build, $source, $copy_build, $copy_source, $records) = @_;
  make_path($records);
  spill("$records/roots", "$copy_build\n$copy_source\n");
  my (%words, %mtime, %names_isas, $object, @files);
  for my $entry (@{decode_json(slurp("$build/compile_commands.json"))}) {
    my @words = shellwords($entry->{command});
    $words{value_of("-o", @words) // ""} = \@words;
  }
  my $count = 0;
  my $keep = sub {
    return unless defined $object && $words{$object};
    my $made = (stat "$build/$object")[9] // return;
    my $isas = 0;
    for my $file (@files) {
      $mtime{$file} //= (stat $file)[9] // 9e99;
      return if $mtime{$file} > $made;
      next unless index($file, "$source/") == 0;
      $names_isas{$file} //= slurp($file) =~ /SHOAL_BUILDS_/ ? 1 : 0;
      $isas ||= $names_isas{$file};
    }
    my @written = map { index($_, "$source/") == 0 ? "<source>" . substr($_, length $source) : $_ }
                  grep { !m{/cmake_pch\.hxx} } @files;
    spill(record_of($records, $object), "$build/$object\n$isas\n",
          comparable($build, $source, $isas, @{$words{$object}}), "\n", map { "$_\n" } @written);
    ++$count;
  };
  open my $deps, "-|", "ninja", "-C", $build, "-t", "deps" or die "ninja: $!\n";
  while (<$deps>) {
    if (/^(\S.*): #deps \d+, .*\((\w+)\)$/) {
      $keep->();
      ($object, @files) = $2 eq "VALID" ? ($1) : (undef);
    } elsif (/^    (.+)$/) {
      my $path = $1;
      $path = "$build/$path" unless $path =~ m{^/};
      1 while $path =~ s{/[^/]+/\.\./}{/};
      push @files, $path;
    }
  }
  $keep->();
  print "$count objects can be reused\n";
}

# Copies the object and writes its dependencies, or returns.
sub reuse {
  my ($records, @words) = @_;
  my ($object, $depfile) = (value_of("-o", @words), value_of("-MF", @words));
  return unless defined $object && defined $depfile && -f record_of($records, $object);
  my ($copy_build, $copy_source) = split /\n/, slurp("$records/roots");
  my ($made, $isas, $wanted, @files) = split /\n/, slurp(record_of($records, $object));
  # The launcher of BUILD itself is not a part of its commands.
  my $got = comparable($copy_build, $copy_source, $isas, @words);
  return unless $got eq $wanted || substr($got, -1 - length $wanted) eq "\t$wanted";
  s{^<source>}{$copy_source}, s{([ #])}{\\$1}g for @files;
  copy($made, $object) or return;
  spill($depfile, "$object: ", join(" \\\n ", @files), "\n");
  exit 0;
}

if (@ARGV && $ARGV[0] eq "--record") {
  record(@ARGV[1 .. $#ARGV]);
} else {
  reuse(@ARGV);
  my (undef, @command) = @ARGV;
  exec @command or die "$command[0]: $!\n";
}
