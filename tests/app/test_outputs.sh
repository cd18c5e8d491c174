#!/bin/bash
# What a render leaves: pictures, layers, reports; and what it leaves where it fails.
source "$(dirname "$0")/checks.sh"
small="--size 61x43"

# --- The same picture is the same file, under any name, at any time, with any threads and tiles
passes "render a PNG" "$shoal" render box -o a.png $small
sleep 1.1  # another second, should a date get in
mkdir other
passes "render it again" "$shoal" render box -o other/b.png $small --threads 1 --tile 32 --quiet
equals "same bytes" "same" "$(cmp a.png other/b.png && echo same)"
aovs=depth,normal,position,id.triangle,id.node,virtual,water.mask,surface.height,surface.normal,hit.kind,hit.position,hit.id,hit.approximate,hit.secondary
passes "render an EXR" "$shoal" render box -o a.exr $small --aov $aovs
sleep 1.1
passes "render it again" "$shoal" render box -o other/b.exr $small --aov $aovs --threads 2 --tile 128
equals "same bytes" "same" "$(cmp a.exr other/b.exr && echo same)"
passes "the order of --aov's names does not matter" "$shoal" render box -o c.exr $small \
  --aov "$(echo $aovs | tr , '\n' | tac | paste -sd ,),depth"
equals "same bytes" "same" "$(cmp a.exr c.exr && echo same)"
equals "no path in the PNG" "0" "$(grep -ac "$work\|a\.png" a.png)"
equals "no path in the EXR" "0" "$(grep -ac "$work\|a\.exr" a.exr)"
equals "no date in the PNG" "" "$(picture chunks a.png | grep -E 'tIME|tEXt|iTXt|zTXt')"
equals "no text in the EXR's header" "" "$(picture attributes a.exr | grep "'" | grep -v "''")"
no_leftovers "renders"

# --- A surface with a past: a frame is the same alone, in a run, and with other threads
filter="--set surface=ripple-filter --set wavelength=0.8"
passes "frames of a filter" "$shoal" render box --frames 0:3 --step 0.5 -o filter%d.png $small $filter
passes "its frame 2 alone" "$shoal" render box --time 1 -o filter.png $small $filter --threads 7
equals "same bytes" "same" "$(cmp filter2.png filter.png && echo same)"
equals "and it moves" "" "$(cmp -s filter1.png filter2.png && echo same)"
refuses 2 "surface ripple-filter: its lifetime takes" "$shoal" render box -o x.png $small $filter --set lifetime=1e6

# --- EXR layers
picture channels a.exr | sort >.channels
sort >.wanted <<END
R float
G float
B float
A float
depth.Z float
normal.X float
normal.Y float
normal.Z float
position.X float
position.Y float
position.Z float
id.triangle uint
id.node uint
virtual.X float
virtual.Y float
virtual.Z float
water.mask uint
surface.height float
surface.normal.X float
surface.normal.Y float
surface.normal.Z float
hit.kind uint
hit.position.X float
hit.position.Y float
hit.position.Z float
hit.id uint
hit.approximate uint
hit.secondary uint
END
equals "EXR channels and types" "" "$(diff .wanted .channels)"
"$shoal" render box -o plain.exr $small
equals "EXR without --aov" "A B G R" "$(picture channels plain.exr | cut -d' ' -f1 | sort | paste -sd ' ')"

# --- probe agrees with the files, pixel by pixel: rows go from the top, and no digit is lost
bits_of() {  # KEY INDEX: of .probe, a float's bits from its hexadecimal notation
  perl -MJSON::PP -e 'local $/; my $v = decode_json(<STDIN>)->{"$ARGV[0]_hex"}; $v = $v->[$ARGV[1]] if ref $v;
    my ($s, $m, $f, $e) = $v =~ /^(-?)0x([01])\.?([0-9a-f]*)p([+-]\d+)$/ or do { print $v eq "inf" ? "7f800000" : $v; exit };
    my $x = $m; $x += hex(substr($f, $_, 1)) / 16 ** ($_ + 1) for 0 .. length($f) - 1;
    printf "%08x", unpack("V", pack("f<", ($s ? -1 : 1) * $x * 2 ** $e))' "$1" "$2" <.probe
}
uint_of() { perl -MJSON::PP -e 'local $/; printf "%08x", decode_json(<STDIN>)->{$ARGV[0]}' "$1" <.probe; }
rgb_of() { perl -MJSON::PP -e 'local $/; print join ",", @{decode_json(<STDIN>)->{final}}' <.probe; }
for xy in "3 2" "57 5" "30 21" "8 40" "44 33"; do
  set -- $xy
  passes "probe --pixel $1,$2" "$shoal" probe box $small --pixel "$1,$2" --json .probe
  equals "$xy: final is the PNG's" "$(picture rgb a.png "$1" "$2")" "$(rgb_of)"
  equals "$xy: lit is the EXR's R" "$(picture sample a.exr R "$1" "$2")" "$(bits_of lit 0)"
  equals "$xy: lit is the EXR's B" "$(picture sample a.exr B "$1" "$2")" "$(bits_of lit 2)"
  equals "$xy: normal.Y" "$(picture sample a.exr normal.Y "$1" "$2")" "$(bits_of normal 1)"
  equals "$xy: id.triangle" "$(picture sample a.exr id.triangle "$1" "$2")" "$(uint_of id.triangle)"
  equals "$xy: hit.kind" "$(picture sample a.exr hit.kind "$1" "$2")" "$(uint_of hit.kind)"
done
equals "probe --pixel's keys" \
  "pixel depth depth_hex normal normal_hex position position_hex id.triangle id.node virtual virtual_hex water.mask surface.height surface.height_hex surface.normal surface.normal_hex hit.kind hit.position hit.position_hex hit.id hit.approximate hit.secondary lit lit_hex final" \
  "$(keys_of .probe)"
passes "probe --point" "$shoal" probe box --point 0.25,-0.5,0.125 --json .point
equals "probe --point's keys" \
  "world world_hex virtual virtual_hex crossing crossing_hex pixel pixel_hex path_m path_m_hex side" "$(keys_of .point)"
equals "probe --point's digits" "0x1p-2 -0x1p-1 0x1p-3" \
  "$(perl -MJSON::PP -e 'local $/; print "@{decode_json(<STDIN>)->{world_hex}}"' <.point)"
exits "probe --json -" 0 "$shoal" probe box $small --pixel 1,1 --json -
equals "probe --json - is JSON alone" "{" "$(head -1 .out)"

# --- render --json
keys="scene method category size triangles water_pixels threads tile isa spp settings version compiler load_ms build_ms write_ms stages_ms frame_ms frames_ms frame_digests counters peak_rss_mb"
passes "render --repeat --json" "$shoal" render box -o r.png $small --repeat 3 --warmup 1 --json r.json --threads 2 --tile 32 \
  --set ior=1.25 --exposure 0.5 --step 0.25
equals "render --json's keys" "$keys" "$(keys_of r.json)"
equals "settings, frames, digests" "1.25 0.5 0.25 2 32 3 3 61,43" "$(perl -MJSON::PP -e 'local $/; my $j = decode_json(<STDIN>);
  my $s = $j->{settings}; print join " ", $s->{ior}, $s->{exposure}, $s->{step}, $s->{threads}, $j->{tile},
  $j->{frame_ms}{n}, scalar @{$j->{frame_digests}}, join(",", @{$j->{size}})' <r.json)"
equals "settings' keys" \
  "method size spp camera time step frames warmup repeat threads tile isa anisotropy shadows shadow-map reflections exposure tonemap background aov triangles water_size depth ior absorption surface geometry" \
  "$(perl -MJSON::PP -e 'local $/; my $s = decode_json(<STDIN>)->{settings}; my @k = qw(method size spp camera time step frames
  warmup repeat threads tile isa anisotropy shadows shadow-map reflections exposure tonemap background aov triangles water_size depth ior absorption
  surface geometry); print join " ", grep { exists $s->{$_} } @k' <r.json)"
passes "the picture of a repeated run is frame 0's" "$shoal" render box -o one.png $small --json one.json \
  --set ior=1.25 --exposure 0.5 --step 0.25
equals "same bytes" "same" "$(cmp r.png one.png && echo same)"
digests() { perl -MJSON::PP -e 'local $/; print join " ", @{decode_json(<STDIN>)->{frame_digests}}' <"$1"; }
equals "its digest too" "$(digests one.json)" "$(digests r.json | cut -d' ' -f1)"
equals "a repeated run turns the camera" "3" "$(digests r.json | tr ' ' '\n' | sort -u | wc -l)"
exits "repeat with --digest, EXR" 0 "$shoal" render box -o r.exr $small --repeat 2 --digest --set ior=1.25
"$shoal" render box -o one.exr $small --digest --set ior=1.25 >.once
equals "repeat: frame 0's stage digests" "$(cat .once)" "$(cat .out)"
equals "repeat: frame 0's EXR" "same" "$(cmp r.exr one.exr && echo same)"
equals "digest lines" "0" "$(grep -cvE '^digest [A-Za-z0-9_.-]+ [0-9a-f]+$' .out)"
equals "some digest lines" "yes" "$([ "$(wc -l <.out)" -ge 2 ] && echo yes)"
exits "--digest --json -" 0 "$shoal" render box $small --digest --json -
equals "digests first, then JSON" "digest {" "$(grep -oE '^(digest|\{)' .out | uniq | paste -sd ' ')"
sed -n '/^{/,$p' .out >.json
equals "JSON after the digests" "$keys" "$(keys_of .json)"

# --- Options that change the picture do, those that must not do not
different() { exits "$1 changes the picture" 0 "$shoal" render box -o d.png $small "${@:2}"
  equals "$1 changes the picture" "different" "$(cmp -s d.png a.png || echo different)"; }
different "--camera" --camera 1
different "--method" --method none
different "--exposure" --exposure 1
different "--set ior" --set ior=1.1
different "--set absorption" --set absorption=5,5,5
different "--background" --background 1,0,0 --camera 1
passes "--camera NAME" "$shoal" render box -o n.png $small --camera "$("$shoal" info box | grep -A1 '^cameras' | tail -1 | xargs)"
equals "the first camera is the default" "same" "$(cmp n.png a.png && echo same)"
for isa in $("$shoal" list isas); do
  passes "--isa $isa" "$shoal" render box -o isa.png $small --isa "$isa"
  equals "--isa $isa: same bytes" "same" "$(cmp isa.png a.png && echo same)"
done

# --- A run of frames: both ends are in
passes "--frames" "$shoal" render box -o "f.%04d.png" $small --frames 2:4 --json f.json
equals "--frames 2:4 writes three" "f.0002.png f.0003.png f.0004.png" "$(ls f.0* | paste -sd ' ')"
equals "--frames: digests" "3" "$(digests f.json | wc -w)"
passes "one frame, %% and no width" "$shoal" render box -o "g%%%d.png" $small --frames 7:7
equals "its name" "yes" "$([ -f g%7.png ] && echo yes)"

# --- Outputs that cannot be written: exit 1, one line, the earlier file as it was
cp a.png keep.png
refuses 1 "nowhere/x.png: cannot be written" "$shoal" render box -o nowhere/x.png $small
mkdir folder.png
refuses 1 "folder.png: cannot be written" "$shoal" render box -o folder.png $small
refuses 1 "nowhere/x.json: cannot be written" "$shoal" render box -o keep.png --camera 1 $small --json nowhere/x.json
ln -s /dev/full full.png
ln -s /dev/full full.exr
refuses 1 "full.png: cannot be written .*No space" "$shoal" render box -o full.png $small
refuses 1 "full.exr: cannot be written .*No space" "$shoal" render box -o full.exr $small
refuses 1 "/dev/full: cannot be written" "$shoal" render box -o keep.png --camera 1 $small --json /dev/full
limited() { (ulimit -f 1; "$@"); }
refuses 1 "keep.png: cannot be written .*too large" limited "$shoal" render box -o keep.png --camera 1 --size 320x200
refuses 1 "x.exr: cannot be written" limited "$shoal" render box -o x.exr --camera 1 --size 320x200
equals "the earlier picture is whole" "same" "$(cmp keep.png a.png && echo same)"
equals "no new picture" "" "$(ls x.exr 2>/dev/null)"
exits "standard output full" 1 bash -c '"$0" list scenes >/dev/full' "$shoal"
equals "says so in one line" "1" "$(grep -c '^shoal: error: standard output' .err)"
exits "standard output closed" 1 bash -c '"$0" info box >&-' "$shoal"
ln -s a.png link.png
passes "a link is written through" "$shoal" render box -o link.png $small --camera 1
equals "and stays a link" "yes" "$([ -L link.png ] && ! cmp -s a.png keep.png && echo yes)"
# A link to a file that is not there yet, directly and by a second link from another folder.
mkdir links targets
ln -s ../targets/new.png links/dangling.png
ln -s links/dangling.png second.png
passes "a dangling link is written through" "$shoal" render box -o second.png $small --camera 1
equals "the links stay and the target is there" "yes" \
  "$([ -L second.png ] && [ -L links/dangling.png ] && cmp -s targets/new.png a.png && echo yes)"
ln -s nowhere/new.png no_folder.png
refuses 1 "no_folder.png: cannot be written" "$shoal" render box -o no_folder.png $small
equals "a link into no folder stays" "yes" "$([ -L no_folder.png ] && echo yes)"
no_leftovers "failed renders"

# --- Interrupted: whole pictures, no partial one
for signal in TERM HUP; do
  mkdir "run$signal"
  "$shoal" render box -o "run$signal/%05d.png" --size 200x150 --frames 0:90000 --quiet &
  run=$!
  for _ in $(seq 200); do [ -f "run$signal/00003.png" ] && break; sleep 0.05; done
  kill -$signal $run
  wait $run 2>.wait
  got=$?
  equals "$signal: ended by the signal" "$((128 + $(kill -l $signal)))" "$got"
  last=$(ls "run$signal" | tail -1)
  passes "$signal: the last picture is whole" "$shoal" diff "run$signal/$last" "run$signal/$last"
done
no_leftovers "interrupted runs"
finish
