#!/bin/bash
# category.sh COMPILE_COMMANDS: the category of a method decides what it can reach. One method whose narrow phase reads
# the BVH is compiled as a method of each category: as a hybrid one it must compile, as a raster or volume one it must
# not, because its input has no member `trace`.
set -uo pipefail
export LC_ALL=C

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "category.sh: $*"; exit 1; }

# The compile command of a method's file, to check a source for errors only.
command=$(grep -m1 '"command":.*refraction/methods/hybrid\.cpp' "$1") || fail "$1 has no method hybrid"
command=${command#*\"command\": \"} command=${command%\",*}
command=${command//\\\"/\"} command=${command//\\\\/\\}
command=$(sed -E 's/ -o [^ ]+/ /; s/ -M(T|F) [^ ]+//g; s/ -MM?D / /; s/ -c [^ ]+$/ -fsyntax-only /' <<<"$command")
# The folder that it runs in stands on the line before it.
directory=$(grep -m1 -B1 '"command":.*refraction/methods/hybrid\.cpp' "$1" | sed -nE 's/.*"directory": "([^"]*)".*/\1/p')
[[ -d $directory ]] || fail "$1 has no folder of method hybrid"

# compiles CATEGORY: status 0 if the method compiles; messages in $work/CATEGORY.txt
compiles() {
  cat >"$work/$1.cpp" <<EOF
#include "refraction/methods/method.h"

namespace shoal::inline SHOAL_ISA_NS {

namespace {
struct ReadsBvh : StraightRays {
  static constexpr MethodCategory kCategory = MethodCategory::$1;
  static void narrow(const NarrowIn<kCategory>& in, const NarrowOut& out, std::size_t) {
    out.hits[0].refracted_id[0] = in.trace.bvh != nullptr ? 1 : 0;
  }
};
}  // namespace

Method reads_bvh() { return ray_method<ReadsBvh>("reads-bvh", "reads the BVH", "none"); }

}  // namespace shoal::inline SHOAL_ISA_NS
EOF
  (cd "$directory" && eval "$command $work/$1.cpp") >"$work/$1.txt" 2>&1
}

status=0
if ! compiles kHybrid; then
  echo "a hybrid method that reads the BVH does not compile:"
  cat "$work/kHybrid.txt"
  status=1
fi
for category in kRaster kVolume; do
  if compiles $category; then
    echo "a method of category $category that reads the BVH compiles; expected an error"
    status=1
    continue
  fi
  # One error, and that one.
  errors=$(grep -E '\berror:' "$work/$category.txt")
  if [[ $(wc -l <<<"$errors") -ne 1 || ! $errors =~ no\ member\ named\ .trace ]]; then
    echo "a method of category $category that reads the BVH fails for another reason than its missing member trace:"
    cat "$work/$category.txt"
    status=1
  fi
done
exit $status
