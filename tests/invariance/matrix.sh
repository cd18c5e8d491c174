#!/bin/bash
# The determinism matrix (docs/DETERMINISM.md): every configuration must print the digests of the first one.
#
#   matrix.sh [FILE.gltf...]   run from scripts/test --matrix, which installs what it needs
#
# Builds go to build/matrix/; the outputs that differ stay there, the first line that differs is printed.
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/common.sh

root=build/matrix
mkdir -p $root/out
reference=""
runs=0 failures=0

# compare NAME FILE: against the first file that came.
compare() {
  runs=$((runs + 1))
  if [[ ! -s $2 ]]; then
    failures=$((failures + 1))
    printf 'FAILED %s: no digests\n' "$1"
  elif [[ -z $reference ]]; then
    reference=$2
  elif cmp -s "$reference" "$2"; then
    rm -f "$2"
  else
    failures=$((failures + 1))
    printf 'DIFFERS %s: %s\n' "$1" "$(diff "$reference" "$2" | sed -n 2,4p | tr '\n' ' ')"
  fi
}

# sweep NAME RUNNER...: every ISA x thread count x tile size of one build.
sweep() {
  local name=$1
  shift
  say "$name"
  local isa threads tile out
  for isa in $("$@" --list-isas); do
    for threads in 1 2 7; do
      for tile in 32 64 128; do
        out=$root/out/$name-$isa-$threads-$tile
        "$@" --isa "$isa" --threads "$threads" --tile "$tile" >"$out" || true
        compare "$name --isa $isa --threads $threads --tile $tile" "$out"
      done
    done
  done
}

# files NAME SHOAL FILE...: the same for scene files, through the command.
files() {
  local name=$1 shoal=$2 isa threads tile method file out
  shift 2
  for file in "$@"; do
    say "$name: $file"
    reference=""
    for isa in $("$shoal" list isas | awk '{ print $1 }'); do
      for threads in 1 2 7; do
        for tile in 32 64 128; do
          out=$root/out/$name-$(basename "$file")-$isa-$threads-$tile
          for method in $("$shoal" list methods | awk '{ print $1 }'); do
            "$shoal" render "$file" --method "$method" --size 240x135 --isa "$isa" --threads "$threads" --tile "$tile" \
              --digest --quiet -o "$root/out/picture.png" || true
          done >"$out"
          compare "$name $file --isa $isa --threads $threads --tile $tile" "$out"
        done
      done
    done
    cp "$reference" "$root/out/$(basename "$file").$name.reference"
  done
}

for compiler in g++ clang++; do
  for level in O3 O0; do
    name=$compiler-$level
    targets=(digest_tool)
    if (( $# > 0 )); then targets+=(shoal); fi
    cmake -S . -B "$root/$name" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" \
      -DSHOAL_OPTIMIZE="-$level" -DSHOAL_TESTS=ON -DSHOAL_BENCH=OFF >"$root/$name.log" 2>&1 || { cat "$root/$name.log"; exit 1; }
    cmake --build "$root/$name" -j "$(jobs)" --target "${targets[@]}"
    sweep "$name" "$root/$name/bin/digest_tool"
  done
done

build neon
sweep neon qemu-aarch64-static build/neon/bin/digest_tool
ctest --preset neon

if (( $# > 0 )); then
  for compiler in g++ clang++; do
    for level in O3 O0; do files "$compiler-$level" "$root/$compiler-$level/bin/shoal" "$@"; done
  done
  for file in "$@"; do
    for name in g++-O0 clang++-O3 clang++-O0; do
      reference=$root/out/$(basename "$file").g++-O3.reference
      compare "$name $file" "$root/out/$(basename "$file").$name.reference"
    done
  done
fi

say "matrix: $runs configurations, $failures differ"
(( failures == 0 ))
