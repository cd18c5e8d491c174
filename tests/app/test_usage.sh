#!/bin/bash
# Wrong usage: exit 2, one line, no file. Right usage of the commands that only print.
source "$(dirname "$0")/checks.sh"

r() { refuses 2 "$1" "$shoal" render box -o x.png --size 32x24 "${@:2}"; }

# --- Commands
refuses 2 "no command; expected one of: render" "$shoal"
refuses 2 "command 'draw': unknown; expected one of: render, compare, diff" "$shoal" draw
refuses 2 "SCENE is required" "$shoal" render
refuses 2 "not expected: --frobnicate" "$shoal" render box --frobnicate
refuses 2 "not expected: extra" "$shoal" render box extra -o x.png
refuses 2 "nothing to write; expected -o" "$shoal" render box
refuses 2 "requires|required|expected" "$shoal" render box -o
passes "--help" "$shoal" --help
equals "--help is on standard output alone" "0" "$(wc -c <.err)"
for command in render compare diff probe scene info list; do
  passes "$command --help" "$shoal" $command --help
  equals "$command --help says something" "yes" "$([ "$(wc -l <.out)" -ge 4 ] && echo yes)"
done
"$shoal" render --help >.help
for option in -o --method --methods --reference --size --spp --camera --time --step --frames --warmup --repeat --threads \
              --tile --isa --anisotropy --set --shadows --shadow-map --reflections --exposure --tonemap --background --aov --digest \
              --json --quiet --triangles; do
  equals "render --help has $option" "yes" "$(grep -qE -- "^ *$option( |,|$)" .help && echo yes)"
done
equals "--frames says that both ends are in" "yes" "$(grep -A3 -e --frames .help | grep -q 'both included' && echo yes)"
passes "--version" "$shoal" --version
equals "--version is one line" "1" "$(grep -cE '^shoal [0-9]+\.[0-9]+\.[0-9]+$' .out)"

# --- Sizes and numbers: the whole text or nothing
for size in 0x720 720x0 100000x100000 12 1280x720x3 x 1280x 1280X720 -1x5 "12 x 5" 1e3x10 16385x1 0x10x 99999999999999999999x1 ""; do
  r "--size" --size "$size"
done
for n in 0 257 -1 1.5 2x "" 1e1 0x2; do r "--spp" --spp "$n"; done
for n in 0 -3 abc 99999999999; do r "--threads" --threads "$n"; done
for n in 0 8 48 512 64.0; do r "--tile" --tile "$n"; done
for s in nan inf 1s "" 1e99 --; do r "--time|requires|expected" --time "$s"; done
r "--step" --step nan
r "--warmup" --warmup -1
r "--repeat" --repeat 0
r "--exposure" --exposure inf
r "--triangles" --triangles 0
r "--triangles '1': box cannot have so few" --triangles 1
refuses 2 "--frames and --repeat exclude" "$shoal" render box -o f%d.png --frames 0:1 --repeat 2

# --- Names
r "--method 'foo': unknown; expected one of: .*hybrid" --method foo
r "option 'depth' of ray-traced: '9' is not allowed; expected a whole number from 1 to 8" --method ray-traced --set depth=9
r "--methods: belongs to shoal compare" --methods none
r "--reference: belongs to shoal compare" --reference none
r "--camera 'nowhere': unknown; expected an index from 0 to" --camera nowhere
r "--camera" --camera 99
r "--camera" --camera -1
r "--isa 'mmx': unknown; expected one of: $("$shoal" list isas | head -1)" --isa mmx
refused_isa=$(for isa in scalar sse4.2 avx2 avx512 neon; do "$shoal" list isas | grep -qx "$isa" || echo "$isa"; done | head -1)
[ -z "$refused_isa" ] || r "--isa '$refused_isa': this (machine cannot run it|build does not have it); expected one of: " --isa "$refused_isa"
r "--anisotropy" --anisotropy 0
r "--anisotropy" --anisotropy 17
r "--shadows 'dark': unknown; expected one of: off, map, rays" --shadows dark
r "--shadows 'on': unknown; expected one of: off, map" --shadows on
r "--shadow-map '1000': not a power of two; expected 256, 512, 1024, 2048, 4096 or 8192" --shadow-map 1000
r "--shadow-map '16384'" --shadow-map 16384
r "--reflections 'all': unknown; expected one of: environment, planar, traced" --reflections all
r "--reflections 'none': unknown" --reflections none
r "--tonemap 'filmic': unknown; expected one of: none, aces" --tonemap filmic
r "--background" --background 1,2
r "--background" --background 1,2,x
r "--background" --background 1,-2,0
r "--background 'sky.hdr': is a file; expected --environment sky.hdr" --background sky.hdr
r "--background" --background sky

# --- --set
r "expected KEY=VALUE" --set ior
r "--set 'colour': unknown key; expected a water key" --set colour=red
r "--set ior '5': out of range; expected 1/3 to 3" --set ior=5
r "--set ior" --set ior=0.2
r "--set ior" --set ior=1.3x
r "--set absorption" --set absorption=1,2
r "--set absorption" --set absorption=-1,0,0
r "--set depth" --set depth=0
r "--set size" --set size=3
r "--set surface 'bumpy': unknown" --set surface=bumpy
r "--set geometry 'flat': unknown; expected one of: normals, displaced" --set geometry=flat
r "--set surface 'bumpy': unknown" --set surface=perlin+bumpy
r "--set slope" --set slope=-0.1
r "--set octaves" --set octaves=1.5
r "--set octaves" --set octaves=9
r "--set fade 'steep': unknown" --set fade=steep
r "unknown key" --set hybrid.nonsense=1
r "--reflections 'scene': is now planar .* or traced .*; expected one of them" --reflections scene
r "unknown" --set three-phase.x=1

# --- Outputs
refuses 2 "-o 'x.jpg': not a picture's name" "$shoal" render box -o x.jpg
refuses 2 "-o 'x': not a picture's name" "$shoal" render box -o x
r "--aov 'depth': a PNG has no layers; expected -o FILE.exr" --aov depth
refuses 2 "--aov 'colour': unknown; expected one of: depth, normal" "$shoal" render box -o x.exr --aov colour
refuses 2 "--aov" "$shoal" render box -o x.exr --aov depth,
refuses 2 "the picture has that name" "$shoal" render box -o x.png --json x.png
for pattern in f.png f%s.png f%d%d.png f%x.png f%.png f%04.png f%-4d.png f%99d.png; do
  refuses 2 "one integer conversion" "$shoal" render box -o "$pattern" --frames 0:1
done
for frames in 3 3: :3 3:1 a:b -1:2 0:1:2 0:9999999999; do
  refuses 2 "--frames" "$shoal" render box -o f%d.png --frames "$frames"
done

# --- Scenes
refuses 2 "scene 'lake': unknown; expected a .gltf or .glb file, or one of: pool" "$shoal" render lake -o x.png
refuses 2 "scene 'x.obj': unknown" "$shoal" info x.obj
refuses 2 "is a file; expected a built-in scene" "$shoal" render x.glb --triangles 10 -o x.png
refuses 2 "expected FILE.glb" "$shoal" scene box
refuses 2 "expected FILE.glb" "$shoal" scene box -o box.obj
refuses 2 "is a file" "$shoal" scene a.glb -o b.glb

# --- probe and list
refuses 2 "one of --pixel X,Y and --point" "$shoal" probe box
refuses 2 "one of --pixel X,Y and --point" "$shoal" probe box --pixel 1,1 --point 0,0,0
refuses 2 "--pixel X '32'" "$shoal" probe box --size 32x24 --pixel 32,0
refuses 2 "--pixel Y '24'" "$shoal" probe box --size 32x24 --pixel 0,24
refuses 2 "--pixel X '-1'" "$shoal" probe box --size 32x24 --pixel -1,0
refuses 2 "--pixel" "$shoal" probe box --pixel 5
refuses 2 "--point" "$shoal" probe box --point 1,2
refuses 2 "--point" "$shoal" probe box --point 1,nan,2
refuses 2 "KIND is required" "$shoal" list
refuses 2 "list 'colours': unknown; expected one of: methods, surfaces, scenes, isas" "$shoal" list colours

# An error stays one line whatever is in a name.
refuses 2 "unknown" "$shoal" render $'two\nlines' -o x.png
equals "nothing was written" "" "$(ls)"

# --- list
passes "list methods" "$shoal" list methods
equals "list methods has hybrid" "1" "$(grep -c '^hybrid ' .out)"
equals "list methods has none" "1" "$(grep -c '^none ' .out)"
passes "list surfaces" "$shoal" list surfaces
equals "list surfaces begins with flat" "flat" "$(head -1 .out | cut -d' ' -f1)"
passes "list scenes" "$shoal" list scenes
equals "list scenes has pool and box" "2" "$(grep -cE '^(pool|box) ' .out)"
isas=$("$shoal" list isas)
[ -n "$isas" ] || fail "list isas" "none"
for isa in $isas; do passes "--isa $isa" "$shoal" render box --size 16x16 --triangles 500 --isa "$isa" -o p.png; done
finish
