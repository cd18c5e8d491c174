#!/bin/bash
# Who includes whom: core <- raster; core <- water; raster, water <- scene; all those <- refraction <- compare <- app.
# Third-party headers stay at the edges, intrinsics in core/wide.
set -uo pipefail
status=0
complain() { echo "$*"; status=1; }

sources() { find "$@" -name '*.h' -o -name '*.cpp' -o -name '*.def' | LC_ALL=C sort; }

# room NAME ALLOWED_ROOMS: quoted includes are paths from the root, into the rooms that NAME sees.
room() {
  local file line path
  while IFS= read -r file; do
    while IFS= read -r line; do
      path=${line#*\"}
      path=${path%%\"*}
      [[ -f $path ]] || complain "$file: includes \"$path\"; expected a path from the root"
      [[ " $2 " == *" ${path%%/*} "* ]] || complain "$file: includes \"$path\"; $1 sees only: $2"
    done < <(grep -E '^[[:space:]]*#[[:space:]]*include[[:space:]]*"' "$file")
  done < <(sources "$1")
}
room core "core"
room raster "core raster"
room water "core water"
room scene "core raster water scene"
room refraction "core raster water scene refraction"
room compare "core raster water scene refraction compare"
room app "core raster water scene refraction compare app"

# The raster path builds from a compiler alone: neither file readers nor libraries.
is_edge() { [[ $1 =~ ^(compare|app)/ || $1 =~ ^scene/(gltf|images|export_glb)[a-z_]*\.(h|cpp)$ ]]; }
for file in $(sources core raster water scene refraction); do
  is_edge "$file" && continue
  if grep -HnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"scene/(gltf|images|export_glb)' "$file"; then
    complain "$file: reads files; only compare and app may"
  fi
  while IFS= read -r header; do
    case $file:$header in
      core/wide/*:immintrin.h | core/wide/*:arm_neon.h) ;;
      core/float_mode.cpp:immintrin.h | core/float_mode.cpp:xmmintrin.h) ;;
      core/digest.cpp:xxhash.h | core/thread_pool.cpp:sched.h) ;;
      *:*[./]*) complain "$file: includes <$header>; expected the standard library only" ;;
    esac
  done < <(sed -nE 's/^[[:space:]]*#[[:space:]]*include[[:space:]]*<([^>]+)>.*/\1/p' "$file")
done
for file in $(sources compare app); do
  if grep -HnE '<(.mmintrin|immintrin|arm_neon)\.h>' "$file"; then complain "$file: intrinsics belong in core/wide"; fi
done
exit $status
