#!/bin/bash
# shoal diff: exit codes, the first difference, JSON, masks and maps.
source "$(dirname "$0")/checks.sh"
small="--size 40x30"
"$shoal" render box -o a.png $small
"$shoal" render box -o b.png $small --camera 1
"$shoal" render box -o c.png --size 40x31
"$shoal" render box -o a.exr $small --aov id.triangle,depth,water.mask
"$shoal" render box -o b.exr $small --aov id.triangle,depth,water.mask --set absorption=9,9,9
"$shoal" render box -o plain.exr $small
cp a.png same.png

exits "equal" 0 "$shoal" diff a.png same.png --json equal.json
equals "equal's text" "equal" "$(cat .out)"
exits "equal EXRs" 0 "$shoal" diff a.exr a.exr
exits "different" 3 "$shoal" diff a.png b.png --json different.json
exits "different EXRs" 3 "$shoal" diff a.exr b.exr --json exr.json
equals "nothing on standard error" "" "$(cat .err)"
keys="equal pixels_differ max_abs first flip psnr_db"
for report in equal different exr; do equals "$report.json's keys" "$keys" "$(keys_of $report.json)"; done
field() { perl -MJSON::PP -e 'local $/; my $v = JSON::PP->new->decode(<STDIN>)->{$ARGV[0]};
  print ref $v eq "ARRAY" ? join(",", @$v) : defined $v ? $v : "null"' "$2" <"$1"; }
equals "equal: psnr" "null" "$(field equal.json psnr_db)"
equals "equal: first" "null" "$(field equal.json first)"
equals "equal: pixels" "0" "$(field equal.json pixels_differ)"
equals "equal: max_abs" "0" "$(field equal.json max_abs | cut -d. -f1)"
flip() { perl -MJSON::PP -e 'local $/; my $f = JSON::PP->new->decode(<STDIN>)->{flip};
  print ref $f ? join(" ", map { $f->{$_} // "null" } @ARGV) : "null"' "${@:2}" <"$1"; }
equals "flip's keys" "kind mean median p95 ppd" \
  "$(perl -MJSON::PP -e 'local $/; print join " ", sort keys %{decode_json(<STDIN>)->{flip}}' <different.json)"
equals "two PNGs: LDR-FLIP at 67.02" "ldr 67.02" "$(flip different.json kind ppd)"
equals "two EXRs: HDR-FLIP" "hdr 67.02" "$(flip exr.json kind ppd)"
equals "equal: no error" "0 0 0" "$(flip equal.json mean median p95 | sed 's/\.0//g')"
equals "different: 0 < median <= p95 <= 1, 0 < mean" "yes" \
  "$(flip different.json mean median p95 | awk '{ print ($1 > 0 && $2 > 0 && $3 >= $2 && $3 <= 1) ? "yes" : "no" }')"
exits "--ppd" 3 "$shoal" diff a.png b.png --ppd 20 --json near.json
equals "--ppd is said" "20" "$(flip near.json ppd | sed 's/\.0$//')"
equals "--ppd changes the error" "different" "$([ "$(flip near.json mean)" != "$(flip different.json mean)" ] && echo different)"
exits "the text has FLIP too" 3 "$shoal" diff a.png b.png
equals "in a line" "$(flip different.json mean | xargs printf 'flip %.6f')" "$(grep flip .out)"
exits "--json -" 3 "$shoal" diff a.png b.png --json -
equals "--json - is JSON alone" "{" "$(head -1 .out)"
exits "--quiet" 3 "$shoal" diff a.png b.png --quiet
equals "--quiet says nothing" "" "$(cat .out)"

# The numbers, counted by an independent reader.
read -r counted largest first psnr < <(picture compare a.png b.png)
equals "pixels_differ" "$counted" "$(field different.json pixels_differ)"
equals "max_abs in codes" "$largest" "$(field different.json max_abs | sed 's/\.0$//')"
equals "first" "$first" "$(field different.json first)"
equals "psnr_db" "$psnr" "$(field different.json psnr_db | xargs printf '%.4f')"

# Masks: only what they show counts. A picture and its map mask themselves.
exits "--map" 3 "$shoal" diff a.png b.png --map map.png --json -
exits "outside of the differences all is equal" 3 "$shoal" diff a.png b.png --mask map.png --json masked.json
equals "the mask holds every difference" "$counted" "$(field masked.json pixels_differ)"
equals "the map's first pixel is the absolute difference" \
  "$(for f in a b; do picture rgb $f.png 3 0 | tr , '\n' >.$f; done; paste -d' ' .a .b | awk '{d = $1 - $2; print d < 0 ? -d : d}' | paste -sd,)" \
  "$(picture rgb map.png 3 0)"
exits "a mask from an EXR's water.mask" 3 "$shoal" diff a.exr b.exr --mask a.exr --json water.json
equals "only water pixels can differ in absorption" "$(field exr.json pixels_differ)" "$(field water.json pixels_differ)"
exits "--map EXR" 3 "$shoal" diff a.exr b.exr --map map.exr
equals "its channels" "B float G float R float" "$(picture channels map.exr | paste -sd ' ')"
exits "--flip-map" 3 "$shoal" diff a.png b.png --flip-map flip.png
equals "it is a picture of the same size" "different" "$("$shoal" diff flip.png a.png --quiet; [ $? = 3 ] && echo different)"
exits "--flip-map EXR, with --map" 3 "$shoal" diff a.png b.png --flip-map flip.exr --map both.png --json -
exits "its mean" 3 "$shoal" diff flip.exr map.exr --json .unused
equals "the error, as grey" "0 0" "$(for c in G B; do
  awk -v a="$(picture sample flip.exr R 5 5)" -v b="$(picture sample flip.exr $c 5 5)" 'BEGIN { print a == b ? 0 : 1 }'; done | paste -sd ' ')"
exits "a mask counts for FLIP" 3 "$shoal" diff a.exr b.exr --mask a.exr --json water.json
equals "only its pixels do" "larger" "$(echo "$(flip water.json mean) $(flip exr.json mean)" | awk '{ print ($1 > $2) ? "larger" : "not" }')"
exits "an equal pair's map is black: no mask" 0 "$shoal" diff a.png same.png --map black.png
refuses 1 "black.png: is black all over" "$shoal" diff a.png b.png --mask black.png
exits "--ppd" 0 "$shoal" diff a.png same.png --ppd 67.02

# Bits, not values: what is no number equals itself, one last bit is a difference. The file is uncompressed, made here.
make_exr() {  # FILE HEX: one pixel, channel R, that float
  perl -e 'my ($bits) = @ARGV; sub attribute { my ($n, $t, $v) = @_; "$n\0$t\0" . pack("V", length $v) . $v }
    my $box = pack("l<4", 0, 0, 0, 0);
    my $header = pack("VV", 20000630, 2) . attribute("channels", "chlist", "R\0" . pack("V4", 2, 0, 1, 1) . "\0")
      . attribute("compression", "compression", "\0") . attribute("dataWindow", "box2i", $box)
      . attribute("displayWindow", "box2i", $box) . attribute("lineOrder", "lineOrder", "\0")
      . attribute("pixelAspectRatio", "float", pack("f<", 1)) . attribute("screenWindowCenter", "v2f", pack("f<2", 0, 0))
      . attribute("screenWindowWidth", "float", pack("f<", 1)) . "\0";
    print $header, pack("Q<", length($header) + 8), pack("l<V", 0, 4), pack("V", hex $bits)' "$2" >"$1"
}
make_exr nan.exr 7fc00000
make_exr one.exr 3f800000
make_exr next.exr 3f800001
make_exr inf.exr 7f800000
exits "not a number equals itself" 0 "$shoal" diff nan.exr nan.exr
exits "not a number and 1" 3 "$shoal" diff nan.exr one.exr --json nan.json
equals "has no largest difference" "null" "$(field nan.json max_abs)"
equals "without green and blue there is no FLIP" "null" "$(flip nan.json mean)"
refuses 1 "nan.exr: has no red, green and blue" "$shoal" diff nan.exr one.exr --flip-map none.png
exits "infinity and 1" 3 "$shoal" diff inf.exr one.exr --json inf.json
exits "one last bit" 3 "$shoal" diff one.exr next.exr --json bit.json
equals "is that large" "1.1920928955078125e-07" "$(grep -oE '"max_abs": [^,]+' bit.json | cut -d" " -f2)"
equals "and there" "0,0,R" "$(field bit.json first)"

# Unreadable, or not to be compared: exit 1.
refuses 1 "none.png: cannot be read .*No such file" "$shoal" diff none.png a.png
refuses 1 "none.png: cannot be read" "$shoal" diff a.png none.png
refuses 1 "c.png: is 40x31; expected 40x30, as a.png is" "$shoal" diff a.png c.png
refuses 1 "a.exr: is an EXR; expected a PNG, as a.png is" "$shoal" diff a.png a.exr
refuses 1 "plain.exr: has the channels" "$shoal" diff a.exr plain.exr
refuses 1 "c.png: is 40x31" "$shoal" diff a.png b.png --mask c.png
: >empty.png
refuses 1 "empty.png: is empty" "$shoal" diff empty.png a.png
echo "no picture at all" >text.png
refuses 1 "text.png: is neither a PNG nor an EXR" "$shoal" diff a.png text.png
mkdir folder.png
refuses 1 "folder.png: " "$shoal" diff a.png folder.png
for size in 9 40 700; do
  head -c $size a.png >cut.png
  refuses 1 "cut.png: is (cut short|neither)" "$shoal" diff a.png cut.png
done
for size in 9 300 3000; do
  head -c $size a.exr >cut.exr
  refuses 1 "cut.exr: cannot be read" "$shoal" diff a.exr cut.exr
done
refuses 1 "nowhere/map.png: cannot be written" "$shoal" diff a.png b.png --map nowhere/map.png
refuses 1 "nowhere/d.json: cannot be written" "$shoal" diff a.png b.png --json nowhere/d.json --map late.png
equals "a failed run writes no map" "" "$(ls late.png 2>/dev/null)"

# Wrong usage: exit 2.
refuses 2 "B is required" "$shoal" diff a.png
refuses 2 "not a picture's name" "$shoal" diff a.png b.png --map map.tif
refuses 2 "--ppd" "$shoal" diff a.png b.png --ppd 0
refuses 2 "--ppd" "$shoal" diff a.png b.png --ppd x
refuses 2 "--flip-map 'm.tif': not a picture's name" "$shoal" diff a.png b.png --flip-map m.tif
refuses 2 "the other map has that name" "$shoal" diff a.png b.png --map m.png --flip-map m.png
refuses 2 "the map has that name" "$shoal" diff a.png b.png --flip-map m.png --json m.png
refuses 2 "the map has that name" "$shoal" diff a.png b.png --map m.png --json m.png
no_leftovers "diff"
finish
