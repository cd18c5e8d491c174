#!/bin/bash
# The determinism matrix (docs/DETERMINISM.md): every configuration must print the digests of the first one.
#
#   matrix.sh [FILE.gltf...]   run from scripts/test --matrix, which installs what it needs
#
# Builds go to build/matrix/; outputs that differ stay in build/matrix/out/.
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/common.sh

root=build/matrix
rm -rf $root/out
mkdir -p $root/out
builds=(g++-O3 g++-O0 clang++-O3 clang++-O0)
status=0

# files_of BUILD FILE...: digests of scene files by every method, through the command, over ISAs, threads and tiles.
files_of() {
  local build=$1 shoal=$root/$1/bin/shoal file isa threads tile method out reference
  shift
  for file in "$@"; do
    reference=$root/out/reference-$(basename "$file")
    for isa in $("$shoal" list isas | awk '{ print $1 }'); do
      for threads in 1 2 7; do
        for tile in 32 64 128; do
          out=$root/out/$build-$(basename "$file")-$isa-$threads-$tile
          for method in $("$shoal" list methods | awk '{ print $1 }'); do
            "$shoal" render "$file" --method "$method" --size 240x135 --isa "$isa" --threads "$threads" --tile "$tile" \
              --digest --quiet -o "$root/out/picture.png" || echo "failed"
          done >"$out"
          if [[ ! -f $reference ]]; then cp "$out" "$reference"; fi
          if cmp -s "$reference" "$out" && ! grep -q failed "$out"; then
            rm -f "$out"
          else
            echo "DIFFERS $build $file --isa $isa --threads $threads --tile $tile: $(diff "$reference" "$out" | sed -n 2p)"
            status=1
          fi
        done
      done
    done
    echo "$build: $file"
  done
}

for build in "${builds[@]}"; do
  compiler=${build%-*} level=${build##*-}
  say "$build"
  cmake -S . -B "$root/$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" \
    -DSHOAL_OPTIMIZE="-$level" -DSHOAL_BENCH=OFF >"$root/$build.log" 2>&1 || { cat "$root/$build.log"; exit 1; }
  cmake --build "$root/$build" -j "$(jobs)" --target digest_tool asset_digest_tool shoal
  tests/invariance/sweep.sh $root/out/reference $root/out "$build" "$root/$build/bin/digest_tool" || status=1
  SHOAL_SWEEP=short tests/invariance/sweep.sh $root/out/reference-assets $root/out "$build-assets" \
    "$root/$build/bin/asset_digest_tool" || status=1
  if (( $# > 0 )); then files_of "$build" "$@"; fi
done

build neon
tests/invariance/sweep.sh $root/out/reference $root/out neon qemu-aarch64-static build/neon/bin/digest_tool || status=1
ctest --preset neon || status=1

say "$( ((status == 0)) && echo 'all digests are equal' || echo 'digests differ: see above')"
exit $status
