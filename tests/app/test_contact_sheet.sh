#!/bin/bash
# scripts/contact_sheet over a folder of two files, one of them broken.
source "$(dirname "$0")/checks.sh"
scripts=$here/../../scripts
programs=$(dirname "$shoal")
sheet() { "$scripts/contact_sheet" "$@"; }

mkdir -p "models/Box One/glTF" models/Bad/glTF-Binary empty
"$shoal" scene box -o "models/Box One/glTF/Box One.glb"
"$shoal" render box --size 64x48 -o "models/Box One/screenshot.png" --quiet
head -c 400 "models/Box One/glTF/Box One.glb" >models/Bad/glTF-Binary/Bad.glb

exits "a folder with a broken file" 1 sheet models -o out --programs "$programs" --size 64x48 --columns 1
equals "its count" "2 files, 1 not rendered: $work/out/sheet.png, $work/out/index.html" "$(tail -n 1 .out)"
equals "the pictures" "Bad_glTF-Binary_Bad_glb.txt Box_One_glTF_Box_One_glb.author.png Box_One_glTF_Box_One_glb.png Box_One_glTF_Box_One_glb.txt index.html sheet.png" \
  "$(ls out | LC_ALL=C sort | paste -sd ' ')"
equals "the sheet is as wide as one cell" "658" \
  "$(perl -e 'open my $f, "<:raw", shift; read $f, my $d, 24; print unpack "N", substr $d, 16, 4' out/sheet.png)"
equals "the page has the error" "1" "$(grep -c 'shoal: error: .*Bad.glb' out/index.html)"
equals "the page has both exit codes" "exit 0 exit 1" "$(grep -oE '^exit [0-9]' out/index.html | LC_ALL=C sort | paste -sd ' ')"
rm -r models/Bad
passes "without it" sheet models -o out --programs "$programs" --size 64x48
passes "methods" sheet --methods box -o methods --programs "$programs" --size 64x48 -- --methods hybrid,none --triangles 200
equals "the methods' sheet is as wide as two cells" "990" \
  "$(perl -e 'open my $f, "<:raw", shift; read $f, my $d, 24; print unpack "N", substr $d, 16, 4' methods/sheet.png)"
exits "a folder and methods" 2 sheet models --methods box
exits "no folder" 2 sheet
exits "no such folder" 1 sheet nowhere
exits "no file" 1 sheet empty
exits "unknown option" 2 sheet models --fast
finish
