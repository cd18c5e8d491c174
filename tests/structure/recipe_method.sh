#!/bin/bash
# recipe_method.sh FOLDER SHOAL BUILD ISA CMAKE_ARGUMENT...: CONTRIBUTING.md's recipe for a method, followed to the
# letter.
#
#   FOLDER  where a copy of the sources is kept and built; a later run builds what has changed
#   SHOAL   the command of this build, which has the digests that are expected
#   BUILD   its folder: the copy's build takes the objects that are the same there (reuse_objects.pl)
#   ISA     the one instruction set that the copy is built for
#
# The recipe's file and its one line are taken from the page itself. They must be all that it takes: two objects are
# compiled, no warning, and the command lists, renders and compares the method. As it stands there it is hybrid with
# its two functions written out, so it has that method's digests.
set -uo pipefail
folder=$(realpath -m "$1") expected=$(realpath "$2") main=$(realpath "$3") isa=$4
shift 4
fail() { echo "FAILED: $*"; exit 1; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
copy=$folder/source build=$folder/build records=$folder/records
mkdir -p "$copy" || exit 1

# A copy of what is built, without what an earlier run added to it. What has not changed keeps its time.
mapfile -t rooms < <(sed -nE 's/^ *add_subdirectory\(([a-z_]+)\).*/\1/p' CMakeLists.txt | grep -vxE 'tests|bench')
rooms+=(CMakeLists.txt cmake)
while IFS= read -r -d '' file; do
  cmp -s "$file" "$copy/$file" && continue
  mkdir -p "$copy/$(dirname "$file")" && cp "$file" "$copy/$file" || fail "no copy of $file"
done < <(find "${rooms[@]}" -type f -print0)
while IFS= read -r -d '' file; do
  [[ -f $file ]] || rm "$copy/$file"
done < <(cd "$copy" && find "${rooms[@]}" -type f -print0)

compile() {
  cmake --build "$build" -j 2 --target shoal >"$folder/$1.log" 2>&1 || { tail -30 "$folder/$1.log"; fail "$1: no build"; }
}
rm -rf "$records"
if [[ -f $main/build.ninja ]]; then perl "$here/reuse_objects.pl" --record "$main" "$PWD" "$build" "$copy" "$records" || exit 1; fi
launcher=$(sed -n 's/^CMAKE_CXX_COMPILER_LAUNCHER:[A-Z]*=//p' "$main/CMakeCache.txt")
launcher="perl;$here/reuse_objects.pl;$records${launcher:+;$launcher}"
cmake -S "$copy" -B "$build" -DSHOAL_ISAS="$isa" -DSHOAL_WERROR=ON -DSHOAL_TESTS=OFF -DSHOAL_BENCH=OFF -DSHOAL_PRECOMPILE=OFF \
  -DCMAKE_CXX_COMPILER_LAUNCHER="$launcher" "$@" >"$folder/configure.log" 2>&1 || { tail -30 "$folder/configure.log"; exit 1; }
compile before
rm -rf "$records"  # what the recipe compiles is compiled
compile before     # generated sources, whose objects were taken over under another path
shoal=$build/bin/shoal
"$shoal" list methods | awk '{ print $1 }' >"$folder/methods.before"

# The recipe: the block of C++ is the file that its text names, and the line goes to methods.def.
recipe=$(awk '/^## / { inside = /^## Recipe: a method$/ } inside' CONTRIBUTING.md)
file=$(grep -oE 'refraction/methods/[a-z_]+\.cpp' <<<"$recipe" | head -1)
line=$(grep -oE 'SHOAL_METHOD\([a-z_]+\)' <<<"$recipe" | head -1)
[[ -n $file && -n $line && ! -e $file ]] || fail "the recipe names no new file and line: '$file', '$line'"
awk '/^ *```/ { inside = /```cpp/; next } inside { sub(/^   /, ""); print }' <<<"$recipe" >"$copy/$file"
[[ -s $copy/$file ]] || fail "the recipe shows no file"
echo "$line" >>"$copy/refraction/methods/methods.def"
changed=$(for room in "${rooms[@]}"; do diff -rq "$room" "$copy/$room"; done | wc -l)
[[ $changed == 2 ]] || fail "$changed files differ, not 2"

compile after
name=$(basename "$file" .cpp) option=$(grep -oE 'return ray_method<[A-Za-z]+>\("[a-z0-9-]+"' "$copy/$file" | cut -d'"' -f2)
objects=$(grep -oE '[A-Za-z0-9_/.-]+\.cpp\.o' "$folder/after.log" | sed 's|.*/||' | sort -u | tr '\n' ' ')
[[ $objects == "kernel_table.isa.cpp.o $name.cpp.o " ]] || fail "the recipe compiled: $objects"

diff <(cat "$folder/methods.before"; echo "$option") <("$shoal" list methods | awk '{ print $1 }') || fail "list methods"
digests() { "$1" render box --camera grazing --size 64x48 --set surface=perlin --set slope=0.1 --shadows off --method "$2" --digest; }
mine=$(digests "$shoal" "$option") || fail "no render"
[[ $mine == "$(digests "$expected" hybrid)" ]] || fail "the recipe's method has other digests than hybrid"
[[ $mine != "$(digests "$shoal" none)" ]] || fail "the recipe's method has the digests of none"
"$shoal" compare box --size 32x24 --shadows off --repeat 1 --warmup 0 --set distance-field.resolution=16 --quiet \
  -o "$folder/compare" || fail "no compare"
grep -q "\"name\": *\"$option\"" "$folder/compare/metrics.json" || fail "compare left $option out"
[[ -s $folder/compare/$option.png ]] || fail "compare left no picture of $option"
echo "$file and $line: $objects"
