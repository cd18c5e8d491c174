#!/bin/bash
# Scenes in and out: built-in ones, files, and files that are broken.
source "$(dirname "$0")/checks.sh"
small="--size 48x36"

field() { perl -MJSON::PP -e 'local $/; my $v = JSON::PP->new->canonical->decode(<STDIN>);
  $v = ref $v eq "ARRAY" ? $v->[$_] : $v->{$_} for split m{/}, $ARGV[0];
  print ref $v ? JSON::PP->new->canonical->encode($v) : defined $v ? $v : "null"' "$2" <"$1"; }

# --- info
passes "info" "$shoal" info box
equals "info names its facts" "scene nodes meshes primitives triangles vertices materials textures lights environment skins animations cameras water bounds warnings" \
  "$(grep -oE '^[a-z]+' .out | paste -sd ' ')"
exits "info --json" 0 "$shoal" info box --json
cp .out box.json
equals "info --json's keys" "scene nodes meshes primitives triangles vertices materials textures lights environment skins animations cameras water bounds warnings" \
  "$(keys_of box.json)"
passes "info --json FILE" "$shoal" info box --json file.json
equals "the same" "same" "$(cmp file.json box.json && echo same)"
passes "info --set" "$shoal" info box --set ior=1.5 --set absorption=1,2,3 --json set.json
equals "water's ior" "1.5" "$(field set.json water/0/ior)"
equals "water's absorption" "[1,2,3]" "$(field set.json water/0/absorption | sed 's/\.0//g')"
exits "pool's cameras" 0 "$shoal" info pool --triangles 1000 --json pool.json
equals "pool's cameras in order" "high grazing under surface" \
  "$(for i in 0 1 2 3; do field pool.json cameras/$i/name; echo; done | paste -sd ' ')"
for n in 1000 20000; do
  passes "--triangles $n" "$shoal" info pool --triangles $n --json n.json
  equals "--triangles $n is met within 10 %" "yes" \
    "$(field n.json triangles | awk -v n=$n '{print ($1 >= 0.9 * n && $1 <= 1.1 * n) ? "yes" : $1}')"
done

# --- scene: what is written comes back, and draws the same picture
passes "scene" "$shoal" scene box -o box.glb
passes "info of it" "$shoal" info box.glb --json back.json
for key in triangles vertices materials textures bounds; do
  equals "box.glb: $key" "$(field box.json $key)" "$(field back.json $key)"
done
"$shoal" render box -o built-in.png $small
passes "render it" "$shoal" render box.glb -o file.png $small
equals "the same picture" "same" "$(cmp built-in.png file.png && echo same)"
passes "write it again" "$shoal" scene box -o again.glb
equals "the same file" "same" "$(cmp box.glb again.glb && echo same)"
refuses 1 "nowhere/box.glb: cannot be written" "$shoal" scene box -o nowhere/box.glb
refuses 1 "/dev/full|full.glb" bash -c 'ln -sf /dev/full full.glb; "$0" scene box -o full.glb' "$shoal"
limited() { (ulimit -f 1; "$@"); }
refuses 1 "again.glb: cannot be written" limited "$shoal" scene box -o again.glb --triangles 2000
equals "the earlier file is whole" "same" "$(cmp box.glb again.glb && echo same)"

# Every built-in scene, moving water and materials with extensions included.
for name in $("$shoal" list scenes | awk '{print $1}'); do
  passes "scene $name" "$shoal" scene $name --triangles 3000 -o $name.glb
  "$shoal" render $name -o built-in.png $small --triangles 3000 --time 0.5
  passes "render $name.glb" "$shoal" render $name.glb -o file.png $small --time 0.5
  equals "$name: the same picture" "same" "$(cmp built-in.png file.png && echo same)"
done

# --- Broken files: exit 1, one line that begins with the file
bad() { refuses 1 "^shoal: error: $1: .+; expected" "$shoal" render "$1" -o bad.png $small; refuses 1 "$1" "$shoal" info "$1"; }
bad none.glb
: >empty.glb
bad empty.glb
: >empty.gltf
bad empty.gltf
for size in 3 12 20 400 5000; do
  head -c $size box.glb >cut$size.glb
  bad cut$size.glb
done
head -c 4096 /dev/zero >zero.glb
bad zero.glb
mkdir folder.glb
bad folder.glb
echo '{"asset": {"version": "2.0"' >half.gltf
bad half.gltf
echo 'not json' >text.gltf
bad text.gltf
# One triangle, with a hole to put the fault in.
triangle() {  # FILE FLOATS INDICES MAX_INDEX_COUNT
  local data
  data=$(perl -e 'print pack("f<9", split /,/, $ARGV[0]), pack("v3", split /,/, $ARGV[1])' "$2" "$3" | base64 -w0)
  cat >"$1" <<END
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": ${5:-0}}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-9, -9, -9], "max": [9, 9, 9]},
  {"bufferView": 1, "componentType": 5123, "count": $4, "type": "SCALAR"}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
 "buffers": [{"byteLength": 42, "uri": "data:application/octet-stream;base64,$data"}]}
END
}
triangle good.gltf 0,0,0,1,0,0,0,1,0 0,1,2 3
passes "a good triangle" "$shoal" render good.gltf -o good.png $small
triangle index.gltf 0,0,0,1,0,0,0,1,0 0,1,7 3
bad index.gltf
triangle nan.gltf nan,0,0,1,0,0,0,1,0 0,1,2 3
bad nan.gltf
triangle inf.gltf 0,0,0,inf,0,0,0,1,0 0,1,2 3
bad inf.gltf
triangle count.gltf 0,0,0,1,0,0,0,1,0 0,1,2 3000000
bad count.gltf
triangle mesh.gltf 0,0,0,1,0,0,0,1,0 0,1,2 3 5
bad mesh.gltf
sed 's|data:application[^"]*|missing.bin|' good.gltf >buffer.gltf
bad buffer.gltf
sed 's|"attributes"|"material": 0, "attributes"|; s|"accessors"|"materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}], "textures": [{"source": 0}], "images": [{"uri": "missing.png"}], "accessors"|' \
  good.gltf >image.gltf
bad image.gltf
equals "no picture came of them" "" "$(ls bad.png 2>/dev/null)"
no_leftovers "broken files"

# --- A camera that no node uses
echo '{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"name": "n"}],
 "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}]}' >camera.gltf
sed 's/{"nodes": \[0\]}/{}/' camera.gltf >no_node.gltf
for file in camera no_node; do
  passes "info $file" "$shoal" info $file.gltf --quiet --json $file.json
  equals "$file: the camera's name" "default" "$(field $file.json cameras/0/name)"
  equals "$file: its node" "null" "$(field $file.json cameras/0/node)"
done

# --- An environment that is a FIFO is refused, and the scene is named
mkfifo fifo.png
echo '{"asset": {"version": "2.0"}, "scenes": [{"extras": {"environment": "fifo.png"}}]}' >fifo.gltf
refuses 1 "fifo.gltf: its environment .*fifo.png: is no regular file; expected" timeout 20 "$shoal" render fifo.gltf -o x.png $small
refuses 1 "error: fifo.png: is no regular file; expected" timeout 20 "$shoal" render box --environment fifo.png -o x.png $small
refuses 2 "sum of 17 surfaces; expected at most 16" "$shoal" render box -o x.png $small \
  --set surface=$(printf 'perlin+%.0s' $(seq 16))perlin

# --- Warnings go to standard error, a line each, and --quiet switches them off
passes "--set ior without water" "$shoal" render good.gltf -o good.png $small --set ior=1.2
equals "warns" "1" "$(grep -c '^shoal: warning: good.gltf: ' .err)"
passes "--quiet" "$shoal" render good.gltf -o good.png $small --set ior=1.2 --quiet
equals "does not warn" "" "$(cat .err)"
finish
