#!/bin/bash
# Environments as a user asks for them: the picture, the cache, the scene's key, colours over it.
. "$(dirname "$0")/checks.sh"

# Radiance pictures of 4 x 2 texels.
hdr() { printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n'; for _ in 1 2 3 4 5 6 7 8; do printf "$1"; done; }
hdr '\x40\x40\x40\x81' >grey.hdr
hdr '\x10\x20\x80\x82' >blue.hdr
export XDG_CACHE_HOME=$work/home
small=(--triangles 1000 --size 96x64 --digest)

digest() { "$shoal" render box "${small[@]}" "$@" 2>/dev/null | tail -1; }
plain=$(digest)
grey=$(digest --environment grey.hdr)
checks=$((checks + 1)); [ -n "$grey" ] && [ "$grey" != "$plain" ] || fail "an environment changes the picture"
equals "the default cache has one file" 1 "$(ls home/shoal | wc -l)"
equals "from the cache" "$grey" "$(digest --environment grey.hdr)"
equals "without a cache" "$grey" "$(digest --environment grey.hdr --no-cache)"
equals "a cache of one's own" "$grey" "$(digest --environment grey.hdr --cache mine --threads 1)"
equals "it has one file" 1 "$(ls mine | wc -l)"
echo junk >"mine/$(ls mine)"
equals "a damaged cache" "$grey" "$(digest --environment grey.hdr --cache mine)"
equals "the name asked for" "$grey" "$(digest --environment grey.hdr --background environment)"
equals "a colour over it is the colour" "$(digest --background 1,0,0)" "$(digest --background 1,0,0 --environment grey.hdr)"
passes "no place for a cache" "$shoal" render box "${small[@]}" --environment blue.hdr --cache grey.hdr/x

passes "a report" "$shoal" render box "${small[@]}" --environment blue.hdr --cache mine --json report.json
grep -q '"environment": "blue.hdr"' report.json && grep -q '"cache": "mine"' report.json &&
  grep -q '"background": "environment"' report.json || fail "the report names the environment" "$(cat report.json)"

# The scene's own, and one that goes over it.
mkdir scene
cp blue.hdr scene
cat >scene/empty.gltf <<'END'
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"extras": {"environment": "blue.hdr", "background": [1, 1, 1]}}]}
END
of_scene() { "$shoal" render scene/empty.gltf --size 32x32 --digest "$@" 2>/dev/null | tail -1; }
own=$(of_scene)
checks=$((checks + 1)); [ -n "$own" ] && [ "$own" != "$(of_scene --background 1,1,1)" ] || fail "the scene's environment is seen"
equals "the same by option" "$own" "$(of_scene --environment blue.hdr)"
checks=$((checks + 1)); [ "$own" != "$(of_scene --environment grey.hdr)" ] || fail "the option goes over the scene's"
passes "info" "$shoal" info scene/empty.gltf
grep -q 'environment scene/blue.hdr' .out || fail "info names the environment" "$(cat .out)"
passes "export" "$shoal" scene box --triangles 1000 -o out.glb

refuses 1 'none.hdr: cannot be opened; expected an image file' "$shoal" render box "${small[@]}" --environment none.hdr
echo text >text.hdr
refuses 1 'text.hdr: is no image of a known format; expected PNG' "$shoal" render box "${small[@]}" --environment text.hdr
refuses 2 'exclude each other' "$shoal" render box "${small[@]}" --cache a --no-cache
refuses 2 "expected --environment sky.hdr" "$shoal" render box "${small[@]}" --background sky.hdr
refuses 2 "not a file's name" "$shoal" render box "${small[@]}" --environment ''
finish
