#!/usr/bin/perl
# An independent reader of what the command writes, for the tests.
#   picture.pl channels FILE.exr        each channel's name and type, in the file's order
#   picture.pl attributes FILE.exr      each header attribute's name and, for strings, its text
#   picture.pl sample FILE.exr C X Y    one sample's 32 bits in hexadecimal (zip or no compression)
#   picture.pl rgb FILE.png X Y         the three codes of one pixel (8-bit RGB)
#   picture.pl compare A.png B.png      pixels that differ, largest difference, the first as X,Y,CHANNEL, PSNR in dB
#   picture.pl chunks FILE.png          the names of its chunks
use strict;
use warnings;
use Compress::Zlib;

sub slurp {
  my ($path) = @_;
  open(my $file, '<:raw', $path) or die "$path: $!\n";
  local $/;
  return <$file>;
}

sub exr_header {
  my ($data) = @_;
  my ($magic, $version) = unpack('VV', $data);
  die "not an EXR\n" unless $magic == 20000630;
  die "more than one part, or tiles\n" if $version & 0x1a00;
  my ($at, @attributes, %by_name) = (8);
  while (ord(substr($data, $at, 1)) != 0) {
    my ($name, $type) = unpack('Z*Z*', substr($data, $at, 512));
    $at += length($name) + length($type) + 2;
    my $size = unpack('V', substr($data, $at, 4));
    push @attributes, [$name, $type];
    $by_name{$name} = substr($data, $at + 4, $size);
    $at += 4 + $size;
  }
  my ($list, @channels) = ($by_name{channels});
  while (length($list) > 1) {
    my $name = unpack('Z*', $list);
    my ($type, $linear, $xs, $ys) = unpack('VVVV', substr($list, length($name) + 1, 16));
    die "sampled\n" unless $xs == 1 && $ys == 1;
    push @channels, [$name, ('uint', 'half', 'float')[$type]];
    $list = substr($list, length($name) + 17);
  }
  return ($at + 1, \@attributes, \%by_name, \@channels);
}

sub exr_sample {
  my ($data, $channel, $x, $y) = @_;
  my ($table, $attributes, $by_name, $channels) = exr_header($data);
  my ($x0, $y0, $x1, $y1) = unpack('l<4', $by_name->{dataWindow});
  my $width = $x1 - $x0 + 1;
  my $compression = ord($by_name->{compression});
  my $lines = {0 => 1, 2 => 1, 3 => 16}->{$compression} or die "compression $compression\n";
  my $offset = unpack('Q<', substr($data, $table + 8 * int($y / $lines), 8));
  my ($first, $size) = unpack('l<V', substr($data, $offset, 8));
  my $packed = substr($data, $offset + 8, $size);
  my $bytes_a_line = 4 * $width * @$channels;
  my $here = $y1 + 1 - $first < $lines ? $y1 + 1 - $first : $lines;
  my $raw = $packed;
  if ($compression != 0 && $size < $bytes_a_line * $here) {
    my @b = unpack('C*', uncompress($packed));
    $b[$_] = ($b[$_ - 1] + $b[$_] - 128) & 255 for 1 .. $#b;
    my $half = int((@b + 1) / 2);
    $raw = pack('C*', map { $_ % 2 ? $b[$half + ($_ >> 1)] : $b[$_ >> 1] } 0 .. $#b);
  }
  for my $c (0 .. $#$channels) {
    next unless $channels->[$c][0] eq $channel;
    return unpack('V', substr($raw, ($y - $first) * $bytes_a_line + 4 * ($c * $width + $x), 4));
  }
  die "no channel $channel\n";
}

sub png_chunks {
  my ($data) = @_;
  die "not a PNG\n" unless substr($data, 0, 8) eq "\x89PNG\r\n\x1a\n";
  my ($at, @chunks) = (8);
  while ($at < length($data)) {
    my ($size, $name) = unpack('NA4', substr($data, $at, 8));
    push @chunks, [$name, substr($data, $at + 8, $size)];
    $at += $size + 12;
  }
  return @chunks;
}

sub png_rows {
  my ($data) = @_;
  my @chunks = png_chunks($data);
  my ($width, $height, $depth, $kind) = unpack('NNCC', $chunks[0][1]);
  die "not 8-bit RGB\n" unless $depth == 8 && $kind == 2;
  my $raw = uncompress(join('', map { $_->[1] } grep { $_->[0] eq 'IDAT' } @chunks));
  my @above = (0) x (3 * $width);
  my @rows;
  for my $row (0 .. $height - 1) {
    my ($filter, @b) = unpack('C*', substr($raw, $row * (3 * $width + 1), 3 * $width + 1));
    for my $i (0 .. $#b) {
      my ($left, $up, $corner) = ($i > 2 ? $b[$i - 3] : 0, $above[$i], $i > 2 ? $above[$i - 3] : 0);
      my $p = $left + $up - $corner;
      my ($pa, $pb, $pc) = (abs($p - $left), abs($p - $up), abs($p - $corner));
      my $paeth = $pa <= $pb && $pa <= $pc ? $left : $pb <= $pc ? $up : $corner;
      $b[$i] = ($b[$i] + (0, $left, $up, ($left + $up) >> 1, $paeth)[$filter]) & 255;
    }
    @above = @b;
    push @rows, [@b];
  }
  return @rows;
}

sub png_compare {
  my ($a, $b) = @_;
  my ($count, $largest, $first, $sum, $n) = (0, 0, 'none', 0, 0);
  for my $y (0 .. $#$a) {
    my %seen;
    for my $i (0 .. $#{$a->[$y]}) {
      my $d = abs($a->[$y][$i] - $b->[$y][$i]);
      $sum += $d * $d;
      ++$n;
      next if $d == 0;
      my $x = int($i / 3);
      $first = "$x,$y," . ('R', 'G', 'B')[$i % 3] if $first eq 'none';
      $largest = $d if $d > $largest;
      ++$count unless $seen{$x}++;
    }
  }
  my $psnr = $sum ? sprintf('%.4f', 10 * log(255 * 255 * $n / $sum) / log(10)) : 'none';
  return "$count $largest $first $psnr";
}

my ($what, $path, @rest) = @ARGV;
my $data = slurp($path);
if ($what eq 'channels') {
  print "$_->[0] $_->[1]\n" for @{(exr_header($data))[3]};
} elsif ($what eq 'attributes') {
  my ($at, $attributes, $by_name) = exr_header($data);
  print "$_->[0]" . ($_->[1] eq 'string' ? " '$by_name->{$_->[0]}'" : '') . "\n" for @$attributes;
} elsif ($what eq 'sample') {
  printf("%08x\n", exr_sample($data, @rest));
} elsif ($what eq 'rgb') {
  my ($x, $y) = @rest;
  my @rows = png_rows($data);
  print join(',', @{$rows[$y]}[3 * $x .. 3 * $x + 2]), "\n";
} elsif ($what eq 'compare') {
  print png_compare([png_rows($data)], [png_rows(slurp($rest[0]))]), "\n";
} elsif ($what eq 'chunks') {
  print "$_->[0]\n" for png_chunks($data);
} else {
  die "unknown: $what\n";
}
