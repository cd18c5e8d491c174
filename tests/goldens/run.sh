#!/bin/bash
# Goldens: small frames of the built-in scenes, every camera and method, and of the files of data/assets/, equal to the
# digest.
#
#   run.sh SHOAL            compares; a failure leaves actual, expected and difference pictures in out/goldens/
#   run.sh SHOAL --update   writes what SHOAL makes instead (scripts/update_goldens does this, and asks for the reason)
#
# A golden is SCENE_CAMERA_METHOD.txt (with the options of water.list WATER_METHOD.txt, for a file
# asset-FILE_CAMERA_TIME.txt), the digest of each stage, and .png, the picture. There is no tolerance. A golden that is missing fails, and so does one that belongs to no scene, camera or
# method.
set -uo pipefail
shoal=$(realpath "${1:?usage: run.sh SHOAL [--update]}")
update=${2:-}
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
goldens=tests/goldens
out=out/goldens
rm -rf $out
mkdir -p $out
scenes=(box pool)
options=(--triangles 2000 --size 160x90 --quiet)
assets=data/assets
asset_options=(--method two-phase --size 320x180 --quiet)
status=0 compared=0
declare -A known
complain() { echo "$*"; status=1; }

cameras_of() {
  "$shoal" info "$1" --triangles 2000 | awk '/^[^ ]/ { on = $1 == "cameras"; next } on && /^  [^ ]/ { print $1 }'
}

# same NAME: digests, and pixels of the picture.
same() {
  cmp -s "$goldens/$1.txt" "$out/$1.txt" && [[ -f $goldens/$1.png ]] &&
    "$shoal" diff --quiet "$goldens/$1.png" "$out/$1.actual.png"
}

# compare NAME: the first stage that differs, and the first pixel of the picture that does.
compare() {
  local name=$1 stage expected=$goldens/$1.png
  compared=$((compared + 1))
  if [[ ! -f $goldens/$name.txt || ! -f $expected ]]; then
    complain "$name: there is no such golden; look at $out/$name.actual.png, then scripts/update_goldens --reason TEXT"
    return
  fi
  if same "$name"; then
    rm -f "$out/$name".*
    return
  fi
  cp "$expected" "$out/$name.expected.png"
  stage=$(diff "$goldens/$name.txt" "$out/$name.txt" | awk '$1 == "<" || $1 == ">" { print $3; exit }')
  local pixel
  pixel=$("$shoal" diff "$expected" "$out/$name.actual.png" --map "$out/$name.difference.png" | awk '$1 == "first"')
  complain "$name: first stage that differs: ${stage:-none}; pixel: ${pixel:-none of the picture}; see $out/$name.*.png"
}

# frame NAME ARGUMENT...: renders it; then compares, or writes the golden.
frame() {
  local name=$1
  shift
  known[$name]=1
  if ! "$shoal" render "$@" --digest -o "$out/$name.actual.png" </dev/null >"$out/$name.txt" 2>"$out/$name.err"; then
    # A method that is not made for the scene has no golden.
    if grep -q 'is not applicable' "$out/$name.err"; then unset "known[$name]"; return; fi
    complain "$name: was not rendered: $(cat "$out/$name.err")"
    return
  fi
  if [[ $update != --update ]]; then
    compare "$name"
    return
  fi
  compared=$((compared + 1))
  if same "$name"; then return; fi
  mv "$out/$name.txt" "$goldens/$name.txt"
  mv "$out/$name.actual.png" "$goldens/$name.png"
  echo "$name"
}

methods=$("$shoal" list methods | awk '!/not the same bytes/ { print $1 }')
for scene in "${scenes[@]}"; do
  for camera in $(cameras_of "$scene"); do
    for method in $methods; do
      frame "${scene}_${camera}_$method" "$scene" --camera "$camera" --method "$method" "${options[@]}"
    done
  done
done
while read -r name arguments; do
  for method in $methods; do
    # shellcheck disable=SC2086  # arguments are words
    frame "${name}_$method" $arguments --method "$method" "${options[@]}"
  done
done <$goldens/water.list
while read -r asset camera time; do
  frame "asset-${asset}_${camera}_$time" "$assets/$asset.glb" --camera "$camera" --time "$time" "${asset_options[@]}"
done <$goldens/assets.list
for file in "$goldens"/*.txt; do
  name=$(basename "$file" .txt)
  [[ -e $file && -z ${known[$name]:-} ]] || continue
  if [[ $update == --update ]]; then
    rm -f "$goldens/$name.txt" "$goldens/$name.png"
    echo "$name (removed)"
  else
    complain "$name: belongs to no scene, camera or method"
  fi
done
if (( compared < 10 )); then complain "only $compared frames were rendered"; fi
exit $status
