#!/bin/bash
# shoal compare: what it leaves, what it says, what it refuses; the report in a real browser where there is one.
source "$(dirname "$0")/checks.sh"
small="--size 61x43 --reference hybrid --repeat 2 --warmup 0"
once="--size 61x43 --reference hybrid --repeat 1 --methods none"
json() { perl -MJSON::PP -e 'local $/; my $j = decode_json(<STDIN>); print eval($ARGV[0])' "$1" <"${2:-out/metrics.json}"; }

# --- One run: the files, the keys in their order, the numbers' kinds
passes "compare" "$shoal" compare box -o out $small --methods none,hybrid --exr --yee --set ior=1.25
equals "quiet where there is no terminal" "" "$(cat .out .err)"
equals "its files" "hybrid.exr hybrid.flip.png hybrid.hit.png hybrid.png metrics.json none.exr none.flip.png none.hit.png \
none.png reference.exr reference.png report.html" "$(ls out | paste -sd ' ')"
no_leftovers "compare"
equals "metrics.json's keys" "scene size reference settings water_pixels methods" "$(keys_of out/metrics.json)"
keys_in_order() { grep -oE "^$1\"[^\"]+\"" out/metrics.json | tr -d ' "' | paste -sd ' '; }
method_keys="name category ms water frame hit_error_px hit_error_m wrong_object wrong_surface secondary_share \
wrong_object_primary wrong_surface_primary spots"
equals "a method's keys" "$method_keys $method_keys" "$(keys_in_order '      ')"
inner="median min n flip psnr_db yee_failed flip psnr_db yee_failed median p95 p99 median p95 p99"
equals "the keys below" "$inner $inner" "$(keys_in_order '        ')"
equals "scene, size, reference" "box 61x43 hybrid" \
  "$(json '"$j->{scene} " . join("x", @{$j->{size}}) . " $j->{reference}"')"
equals "settings" "1.25 1 2 0 67.02" \
  "$(json 'join " ", map { $j->{settings}{$_} } qw(ior spp repeat warmup ppd)')"
equals "the method is no setting of all" "" "$(json '$j->{settings}{method} // ""')"
equals "as many times as were asked for" "2 2" "$(json 'join " ", map { $_->{ms}{n} } @{$j->{methods}}')"
equals "the categories" "raster hybrid" "$(json 'join " ", map { $_->{category} } @{$j->{methods}}')"
equals "the order asked for" "none hybrid" "$(json 'join " ", map { $_->{name} } @{$j->{methods}}')"
equals "water_pixels is render's" "$("$shoal" render box --size 61x43 --json - | grep -oE '"water_pixels": [0-9]+' | cut -d' ' -f2)" \
  "$(json '$j->{water_pixels}')"

# --- A method is like itself, another is not
equals "itself: no error at all" "0 0 null 0 0 0 0 0" "$(json 'my $m = $j->{methods}[1]; join " ", map { defined $_ ? 0 + $_ : "null" }
  $m->{water}{flip}, $m->{frame}{flip}, $m->{frame}{psnr_db}, $m->{water}{yee_failed}, $m->{hit_error_px}{p99},
  $m->{hit_error_m}{p99}, $m->{wrong_object}, $m->{wrong_surface}')"
equals "no refraction is wrong" "yes" "$(json 'my $m = $j->{methods}[0];
  $m->{water}{flip} > $m->{frame}{flip} && $m->{frame}{flip} > 0 && $m->{water}{psnr_db} < $m->{frame}{psnr_db} &&
  $m->{hit_error_px}{p99} >= $m->{hit_error_px}{p95} && $m->{hit_error_px}{p95} >= $m->{hit_error_px}{median} &&
  $m->{hit_error_px}{median} > 0.5 && $m->{wrong_object} > 0 && $m->{wrong_object} <= 1 && $m->{wrong_surface} > 0 &&
  $m->{water}{yee_failed} <= $m->{frame}{yee_failed} ? "yes" : "no"')"

equals "itself has no spot" "0" "$(json 'scalar @{$j->{methods}[1]{spots}}')"
equals "where no refraction is worst" "x y size_px flip_max: yes" "$(grep -oE '^          "[^"]+"' out/metrics.json | tr -d ' "' | head -4 |
  paste -sd ' '): $(json 'my $s = $j->{methods}[0]{spots}; @$s > 0 && @$s <= 10 && !(grep { $_->{size_px} > $s->[0]{size_px} ||
  $_->{flip_max} < 0.1 || $_->{flip_max} > 1 || $_->{x} < 0 || $_->{x} > 60 || $_->{y} < 0 || $_->{y} > 42 } @$s) ? "yes" : "no"')"

# --- The pictures are render's, the metrics are diff's
"$shoal" render box -o one.png --size 61x43 --method none --set ior=1.25 --reflections traced
equals "render's picture, to the byte" "same" "$(cmp one.png out/none.png && echo same)"
"$shoal" diff out/reference.png out/none.png --json diff.json >/dev/null
equals "diff's FLIP" "$(json '$j->{flip}{mean}' diff.json)" "$(json '$j->{methods}[0]{frame}{flip}')"
equals "diff's PSNR" "$(json 'sprintf "%.9f", $j->{psnr_db}' diff.json)" "$(json 'sprintf "%.9f", $j->{methods}[0]{frame}{psnr_db}')"
"$shoal" diff out/reference.exr out/none.exr --mask out/reference.exr --json water.json >/dev/null
"$shoal" diff out/reference.png out/none.png --mask out/reference.exr --json water.json >/dev/null
equals "diff's FLIP on the water" "$(json '$j->{flip}{mean}' water.json)" "$(json '$j->{methods}[0]{water}{flip}')"
equals "hit buffers in the EXR" "4" "$(picture channels out/none.exr | grep -cE '^(hit.kind|hit.id|hit.position.X|water.mask) ')"

# --- The report needs nothing else, and says how to make it again
equals "no address in it" "0" "$(grep -oE '(src|href)="[^"]{0,8}' out/report.html | grep -vcE '"data:')"
equals "nothing to load from the style" "0" "$(grep -cE '@import|url\(' out/report.html)"
equals "made for phones" "1" "$(grep -c 'name="viewport"' out/report.html)"
equals "the command line" "1" "$(grep -cF "shoal compare box -o out --size 61x43 --reference hybrid --repeat 2 --warmup 0 --methods none,hybrid --exr --yee --set ior=1.25" out/report.html)"

# --- Sweeps
passes "--sweep view-angle" "$shoal" compare box -o angle $small --methods none --sweep view-angle=20,60
equals "its lines" "view-angle 20 60" "$(cut -d, -f1 angle/sweep.csv | paste -sd ' ')"
equals "angles differ" "2" "$(tail -n +2 angle/sweep.csv | cut -d, -f4 | sort -u | wc -l)"
equals "its charts are in the report" "6" "$(grep -c '<figcaption>.* against view-angle' angle/report.html)"
passes "--sweep of a water key" "$shoal" compare box -o ior $small --methods none --sweep ior=1,1.5
equals "nothing bends at 1" "0" "$(sed -n 2p ior/sweep.csv | cut -d, -f5)"
passes "--sweep time" "$shoal" compare box -o time $once --sweep time=0,1 --quiet
passes "--sweep triangles" "$shoal" compare box -o tri $once --sweep triangles=300,500

# --- A folder that is there: its other files stay, ours are new; a failure leaves everything as it was
mkdir kept
echo mine >kept/notes.txt
echo old >kept/report.html
passes "into a folder that is there" "$shoal" compare box -o kept $small --methods none
equals "other files stay" "mine" "$(cat kept/notes.txt)"
equals "ours are new" "yes" "$([ "$(wc -c <kept/report.html)" -gt 10000 ] && echo yes)"
cp kept/metrics.json before.json
refuses 1 "nowhere.gltf: cannot be opened" "$shoal" compare nowhere.gltf -o kept $small
equals "a failed run leaves them" "same" "$(cmp before.json kept/metrics.json && echo same)"
refuses 1 "nowhere.gltf: cannot be opened" "$shoal" compare nowhere.gltf -o fresh $small
equals "and makes no folder" "" "$(ls -d fresh 2>/dev/null)"
echo file >plain
refuses 1 "plain: cannot be written \(is a file\)" "$shoal" compare box -o plain $small
equals "a sweep over time" "0 1" "$(tail -n +2 time/sweep.csv | cut -d, -f1 | paste -sd ' ')"
refuses 1 "no/where: cannot be made .*No such" "$shoal" compare box -o no/where $small
if [ "$(id -u)" != 0 ]; then
  mkdir locked
  chmod 500 locked
  refuses 1 "locked/report.html: cannot be written" "$shoal" compare box -o locked $small
fi
limited() { (ulimit -f 20; "$@"); }
refuses 1 "big/.*: cannot be written .*too large" limited "$shoal" compare box -o big --size 200x150 --repeat 1
equals "a run that fails late makes no folder" "" "$(ls -d big 2>/dev/null)"
"$shoal" compare box -o stopped --size 320x200 --reference none --methods hybrid --repeat 100000 --quiet &
run=$!
for _ in $(seq 200); do [ -d stopped ] && break; sleep 0.05; done
kill -TERM $run
wait $run 2>.wait
equals "a stopped run" "$((128 + 15))" "$?"
equals "makes none either" "" "$(ls -d stopped 2>/dev/null)"
no_leftovers "failed runs"

# --- Wrong usage: exit 2, before anything is drawn or made
c() { refuses 2 "$1" "$shoal" compare box -o no "${@:2}"; }
refuses 2 "nowhere to write to; expected -o DIR" "$shoal" compare box
refuses 2 "SCENE is required" "$shoal" compare -o no
c "--methods 'foo': unknown; expected one of: .*hybrid" --methods none,foo
c "--methods ''" --methods ""
c "--methods 'none,none': has none twice" --methods none,none
c "--reference 'foo': unknown" --reference foo
c "not expected: none --method" --method none
c "not expected: 0:1 --frames" --frames 0:1
c "not expected: --digest" --digest
c "--aov: a PNG has no layers; expected --exr" --aov depth
c "--repeat" --repeat 0
c "--ppd" --ppd 0
c "--size" --size 0x3
c "--set 'nonsense': unknown key" --set nonsense=1
c "--sweep 'ior': not understood; expected KEY=A,B,C" --sweep ior
c "--sweep 'ior=1,,2': a value is empty" --sweep ior=1,,2
c "--set ior 'x'" --sweep ior=1,x
c "--set 'nonsense': unknown key" --sweep nonsense=1,2
c "--sweep view-angle '91'" --sweep view-angle=30,91
c "--time" --sweep time=0,later
refuses 2 "scene 'bo': unknown" "$shoal" compare bo -o no
refuses 2 "render.*--methods|--methods: belongs to shoal compare" "$shoal" render box -o x.png --methods none
equals "nothing was made" "" "$(ls -d no 2>/dev/null)"

# --- In a browser: nothing on the console, the slider moves, every picture is there, a phone's width is enough
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
if [ -z "$browser" ]; then
  echo "SKIPPED: no Chromium here, the report is not opened in a browser"
else
  cat out/report.html - >checked.html <<'PAGE'
<script>
  window.addEventListener("load", async () => {
    const range = document.querySelector("#slider input"), over = document.querySelector(".slider .over");
    const bar = document.querySelector(".slider .bar"), box = document.getElementById("slider");
    await Promise.all([...document.images].map((i) => i.decode()));
    const at = () => Math.round(100 * (bar.getBoundingClientRect().left + 1 - box.getBoundingClientRect().left) / box.clientWidth);
    const seen = ["opened at " + at()];
    for (const v of [10, 90]) {
      range.value = v;
      range.dispatchEvent(new Event("input", { bubbles: true }));
      seen.push(v + " at " + at() + " " + getComputedStyle(over).clipPath);
    }
    const left = document.getElementById("left");
    left.value = "none.flip";
    left.dispatchEvent(new Event("change", { bubbles: true }));
    seen.push("left " + (over.src === document.getElementById("none.flip").src));
    seen.push("pictures " + [...document.images].every((i) => i.naturalWidth > 0) + " " + document.images.length);
    const spots = document.querySelector("details.spots");
    spots.open = true;
    await new Promise((done) => setTimeout(done, 100));
    const canvases = [...spots.querySelectorAll("canvas")];
    const drawn = canvases.every((c) => c.getContext("2d").getImageData(0, 0, 32, 32).data.some((v, i) => i % 4 < 3 && v > 0));
    seen.push("spots " + (canvases.length === 2 * spots.querySelectorAll("figure").length && drawn));
    seen.push("fits " + (document.documentElement.scrollWidth <= innerWidth));
    document.body.innerHTML = "";
    document.body.append("checked: " + seen.join("; "));
  });
</script>
PAGE
  for width in 1280 500; do
    # On a busy machine the browser's time budget can end before the page's script ran: then, and only then, again.
    for attempt in 1 2 3; do
      timeout 120 "$browser" --headless=new --no-sandbox --disable-gpu --user-data-dir="$work/profile$attempt" \
        --enable-logging=stderr --virtual-time-budget=10000 --window-size=$width,900 \
        --dump-dom "file://$work/checked.html#left=none&right=hybrid&at=25" >.dom 2>.log
      if grep -q 'checked: opened' .dom; then break; fi
    done
    equals "$width px wide" "checked: opened at 25; 10 at 10 inset(0px 90% 0px 0px); 90 at 90 inset(0px 10% 0px 0px); left true; pictures true 9; spots true; fits true" \
      "$(grep -o 'checked: opened[^<]*' .dom)"
    equals "$width px wide: nothing on the console" "" "$(grep CONSOLE .log)"
  done
fi
finish
