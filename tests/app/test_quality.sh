#!/bin/bash
# scripts/quality and what it makes of its comparisons; scripts/animation.
source "$(dirname "$0")/checks.sh"
scripts=$here/../../scripts

# A made-up scene of two methods and the one that is judged: which goals count as missed, and how cells are written.
cat >rows.csv <<'CSV'
scene,geometry,camera,slope,method,flip,psnr_db,hit_px_median,hit_px_p95,hit_px_p99,wrong_object,wrong_surface,ms,folder
lake,normals,left,0,hybrid,0.0100,30,0.01,0.1,0.2,0.0005,0.001,5,out/a
lake,normals,left,0,steel-2024,0.0095,30,0.01,0.1,0.2,0.0100,0.001,5,out/a
lake,normals,right,0,hybrid,0.0101,30,0.05,0.1,0.2,0.0005,0.001,5,out/b
lake,normals,right,0,steel-2024,0.0200,30,0.01,0.1,0.2,0.0100,0.001,5,out/b
lake,displaced,left,0.05,hybrid,0.0190,30,,,,0.0100,0.001,5,out/c
lake,displaced,left,0.05,steel-2024,0.0180,30,0.01,0.1,0.2,0.0400,0.001,5,out/c
lake,displaced,left,0.15,hybrid,0.0390,30,0.01,0.1,0.2,0.0050,0.001,5,out/d
lake,displaced,left,0.15,none,0.0370,30,0.01,0.1,0.2,0.0010,0.001,5,out/d
pit,normals,left,0.05,failed,,,,,,,,,out/e
CSV
passes "tables" "$scripts/quality_tables" rows.csv 64x48
cp .out tables.md
equals "rows in full" "1 of 4" "$(grep -o '[0-9]* of [0-9]* are met' tables.md | sed 's/ are met//')"
equals "the first row's" "" "$(grep '^| lake | left | 0 ' tables.md)"
equals "FLIP over its goal, and a median" 1 "$(grep -c '^| lake | right | 0 | FLIP 0.0101 over 0.01; median hit error 0.050 px | `out/b/' tables.md)"
equals "a fifth of steel-2024's" 1 "$(grep -c "displaced | left | 0.05 | wrong object 1.00 %, over a fifth of steel-2024's 4.00 % |" tables.md)"
equals "the lowest" 1 "$(grep -c 'displaced | left | 0.15 | FLIP 0.0390, none 0.0370; wrong object 0.50 %, none 0.10 % |' tables.md)"
equals "a cell of two cameras" 1 "$(grep -c '^| hybrid | 0.0100 / 0.0101\\\* | 0.05 / 0.05 |$' tables.md)"
passes "a summary" "$scripts/quality_tables" --summary rows.csv 64x48
equals "means of the plane's rows" 1 "$(grep -c '^| steel-2024 | 2 | 0.014[78] | 1.00 |$' .out)"
equals "rows that miss a goal" 3 "$(grep -c '^- `lake' .out)"
passes "its chart" "$scripts/quality_tables" --chart rows.csv
"$scripts/bar_chart" chart.svg "made up" <.out || fail "the chart is drawn"
equals "two groups of one bar, paper and legend" 4 "$(grep -c '^<rect' chart.svg)"
echo name,value | "$scripts/bar_chart" none.svg "no line" 2>.err && fail "a chart of nothing is refused"
printf 'before\n<!-- tables: scripts/quality --page -->\nold\n<!-- end of tables -->\nafter\n' >page.md
passes "into a page" "$scripts/quality_tables" --into page.md tables.md
equals "the page" "before after" "$(sed -n '1p;$p' page.md | xargs)"
equals "what was there is gone" "" "$(grep old page.md)"
echo nothing >page.md
"$scripts/quality_tables" --into page.md tables.md 2>.err && fail "a page without marks is refused"
equals "and left as it is" nothing "$(cat page.md)"

passes "a scene" "$scripts/quality" --size 32x24 --scenes box --methods hybrid,none --program "$shoal" -o "$work/q"
equals "nine runs of two methods, and a head" 19 "$(wc -l <q/rows.csv)"
cp q/rows.csv first.csv
passes "resumed" "$scripts/quality" --size 32x24 --scenes box --methods hybrid,none --program "$shoal" -o "$work/q" --resume
equals "all kept" 9 "$(grep -c ': kept$' .out)"
passes "the same rows" cmp q/rows.csv first.csv

programs=$(dirname "$shoal")
if [ -x "$programs/frame_changes" ] && [ -x "$programs/compose_sheet" ]; then
  # The reference beside itself, so that every step is the same.
  "$scripts/animation" --scene box --method ray-traced --size 48x32 --frames 3 --step 0.1 --programs "$programs" -o "$work/a" \
    -- --quiet --set surface=perlin --set slope=0.1 >.out 2>.err
  equals "a method that is the reference" 0 "$?"
  equals "two steps" 3 "$(wc -l <a/changes.csv)"
  equals "of equal change" "1.0000 1.0000" "$(sed 1d a/changes.csv | cut -d, -f 4 | xargs)"
  equals "that is some" yes "$(awk -F, 'NR > 1 && $2 <= 0 { none = 1 } END { print none ? "no" : "yes" }' a/changes.csv)"
  equals "the sheets" "a/strip.png a/worst.png" "$(ls a/strip.png a/worst.png | xargs)"
else
  echo "SKIPPED: scripts/animation: frame_changes and compose_sheet are not built beside $shoal"
fi
finish
