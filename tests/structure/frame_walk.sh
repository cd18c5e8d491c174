#!/bin/bash
# shellcheck disable=SC2016 # a program of Perl
# frame_walk.sh [PAGE]: docs/FRAME.md describes the frame that the sources draw.
#
# - Every linked file exists.
# - Each entry "- **Stage** `S`: function `F`, in `I`, out `O`, file(s) [..](..)" is true: S is a stage's name in the
#   sources of the frame, they call F, one of the linked headers declares F with I among its parameters and O among its
#   parameters or as its result, and the linked headers have both types.
# - Every other `name` is a whole identifier of a file that its paragraph links, or the name of a test, a stage or a
#   method.
# - Every stage and every kernel of frame.cpp and water_body.cpp is in an entry or named.
set -uo pipefail
exec perl -w - "${1:-docs/FRAME.md}" <<'PERL'
use strict;
my $page = shift;
my $status = 0;
sub complain { print "$page: @_\n"; $status = 1; }
sub slurp {
  my ($file) = @_;
  open(my $in, '<', $file) or do { complain("there is no $file"); return ''; };
  local $/;
  my $text = <$in>;
  return $text;
}
my %text_of;
sub code_of {  # without comments
  my ($file) = @_;
  $text_of{$file} //= slurp($file) =~ s{//[^\n]*}{}gr;
  return $text_of{$file};
}
sub has { my ($file, $name) = @_; return code_of($file) =~ /(?<![A-Za-z0-9_])\Q$name\E(?![A-Za-z0-9_])/; }

my @frame = ('refraction/frame.cpp', 'refraction/water_body.cpp');
my $frame = join("\n", map { code_of($_) } @frame);
my (%stages, %kernels);
$stages{$1} = 1 while $frame =~ /Stage stage\(run, "([^"]+)"\)/g;
if ($frame =~ /kRegionStageNames\[[^]]*\] = \{([^}]*)\}/) {
  my $names = $1;
  $stages{$1} = 1 while $names =~ /"([^"]+)"/g;
}
while ($frame =~ /\{((?:"[a-z_.]+",\s*){4})"visibility\./g) {
  my $names = $1;
  $stages{$1} = 1 while $names =~ /"([a-z_.]+)"/g;
}
my %fields = map { $_ => 1 } qw(map rays shown_rays own_reflected lights_layer misses whole_scene traces searches
                              searches_behind);  # no stage
while ($frame =~ /\b(?:kernels|method)\.([a-z_]+)/g) { $kernels{$1} = 1 unless $fields{$1}; }
$kernels{$1} = 1 while $frame =~ /(?<![\w.>])([a-z_]+)\(\{/g;  # stages that are no kernels
complain("found only " . keys(%stages) . " stages and " . keys(%kernels) . " kernels in @frame")
  if keys(%stages) < 15 || keys(%kernels) < 15;
my $methods = slurp('refraction/methods/methods.def') =~ tr/_/-/r;

my $text = slurp($page);
$text =~ s/^```.*?^```//gms;
my (%walked, %named);
my $entries = 0;
for my $paragraph (split /\n\s*\n|\n(?=- )/, $text) {
  my @files;
  while ($paragraph =~ /\]\(([^)#]+)\)/g) {
    my $file = "docs/$1" =~ s{docs/\.\./}{}r;
    if (!-e $file) { complain("the link ($1) leads nowhere"); next; }
    push @files, $file;
  }
  $paragraph =~ s/\s+/ /g;
  my @sources = grep { /\.(h|cpp)$/ } @files;
  if ($paragraph =~ /^\s*- \*\*Stage/) {
    if ($paragraph !~ /^\s*- \*\*Stage\*\* `([^`]+)`: function `(\w+)`, in `(\w+)`, out `(\w+)`, files? \[/) {
      complain("this entry has another form: $paragraph");
      next;
    }
    my ($stage, $function, $in, $out) = ($1, $2, $3, $4);
    $entries++;
    $walked{$stage} = $named{$function} = 1;
    complain("no stage of @frame is named $stage") unless $stages{$stage};
    complain("@frame do not call $function") unless $kernels{$function};
    for my $type ($in, $out) {
      complain("$stage: none of @sources has $type") unless grep { has($_, $type) } @sources;
    }
    my $declared = 0;
    for my $file (@sources) {
      my $code = code_of($file);
      while ($code =~ /([\w:]+)[ *&]+\(?\*?$function\)?\(([^()]*)\)/g) {
        my ($result, $parameters) = ($1, $2);
        $declared = 1 if $parameters =~ /\b$in\b/ && ($parameters =~ /\b$out\b/ || $result eq $out);
      }
    }
    complain("$stage: none of @sources declares $function of $in and $out") unless $declared;
    next;
  }
  while ($paragraph =~ /`([^`]+)`/g) {
    my $name = $1;
    next if $name =~ /^(--|shoal )/ || $name eq 'In' || $name eq 'Out';
    if ($name =~ /^structure\.(\w+)$/) {
      complain("there is no test $name") unless -e "tests/structure/$1.sh";
    } elsif ($name =~ /-/) {
      complain("there is no method $name") unless $methods =~ /\(\Q$name\E\)/;
    } elsif ($name =~ /\./) {
      complain("no stage is named $name") unless $stages{$name};
    } elsif (!@sources) {
      complain("`$name` is in a paragraph that links no source");
    } else {
      $named{$name} = 1;
      complain("`$name` is in none of @sources") unless grep { has($_, $name) } @sources;
    }
  }
}
complain("found $entries entries only") if $entries < 15;
for (sort keys %stages) { complain("the stage $_ is not walked through") unless $walked{$_}; }
for (sort keys %kernels) { complain("the kernel $_ is not named") unless $named{$_}; }
exit $status;
PERL
