#!/bin/bash
# scripts/in_water: a file of each kind, in a basin; and what it refuses.
source "$(dirname "$0")/checks.sh"

assets=$here/../../data/assets
in_water=$here/../../scripts/in_water
# A triangle of 2 x 3 m whose corners are in a file of their own.
perl -e 'print pack "f<9", 0, 0, 0, 2, 0, 0, 0, 3, 0' >"a b.bin"
cat >triangle.gltf <<'JSON'
{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [2, 3, 0]}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"uri": "a%20b.bin", "byteLength": 36}]}
JSON
for file in "$assets"/geometry.glb triangle.gltf; do
  name=$(basename "$file")
  passes "$name in water" "$in_water" "$file" -o "new/$name" --program "$shoal"
  passes "$name is read" "$shoal" info "new/$name"
  equals "$name has water" "water 1" "$(grep '^water' .out)"
  equals "$name has cameras" "high grazing under" "$(awk '/^[^ ]/ { on = $1 == "cameras"; next } on && /^  [^ ]/ { print $1 }' .out | xargs)"
  # The basin, and what stands on its floor 1.4 m high.
  equals "$name: the floor" "-0.9" "$(awk '$1 == "min" { printf "%.4g", $3 }' .out)"
  equals "$name: the top" "0.5" "$(awk '$1 == "max" { printf "%.4g", $3 }' .out)"
  passes "$name is drawn" "$shoal" render "new/$name" --size 48x32 --shadows off --json report.json --quiet
  equals "$name shows water" yes "$(grep -qE '"water_pixels": [1-9]' report.json && echo yes)"
done
exits "two kinds" 2 "$in_water" "$assets/geometry.glb" -o new.gltf --program "$shoal"
exits "no file" 1 "$in_water" none.glb -o new.glb --program "$shoal"
finish
