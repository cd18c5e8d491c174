#!/bin/bash
# Which room includes which: core <- raster <- shading; core <- water; all four <- scene <- trace; all of these
# <- refraction <- compare <- app. Which folder of a room includes which other one of it: the table `folders`. Third-party
# headers stay at the edges, intrinsics in core/wide.
set -uo pipefail

# Lines "file header kind" of every include, kind q (quoted) or s (system).
includes() {
  find core raster shading water scene trace refraction compare app \( -name '*.h' -o -name '*.cpp' -o -name '*.def' \) -print0 |
    xargs -0 awk '/^[ \t]*#[ \t]*include[ \t]*["<]/ {
      kind = /</ ? "s" : "q"
      sub(/^[^"<]*["<]/, "")
      sub(/[">].*$/, "")
      print FILENAME, $0, kind
    }' | LC_ALL=C sort
}

declare -A sees=([core]="core" [raster]="core raster" [shading]="core raster shading" [water]="core water")
sees[scene]="core raster shading water scene"
sees[trace]="${sees[scene]} trace"
sees[refraction]="${sees[trace]} refraction"
sees[compare]="${sees[refraction]} compare"
sees[app]="${sees[compare]} app"

# The folders of rooms that have some, and the other folders of the same room that each one sees. A room's own name stands
# for the files at its top; one header instead of a folder stands for itself.
declare -A folders=(
  [core]="core/wide" [core/wide]=""
  [shading]="shading/environment shading/textures" [shading/environment]="" [shading/textures]="shading/srgb.h"
  [shading/shadow]="shading"
  [scene]="" [scene/build]="scene" [scene/procedural]="scene" [scene/images]="" [scene/gltf]="scene scene/build scene/images"
  [refraction/broad]="" [refraction/data]="refraction/broad" [refraction/field]="refraction/data"
  [refraction/passes]="refraction/broad refraction/data"
  [refraction/narrow]="refraction/passes refraction/broad refraction/data"
)
folders[refraction/methods]="refraction/narrow refraction/field ${folders[refraction/narrow]}"
folders[refraction]="refraction/methods ${folders[refraction/methods]}"
# Light on hits reads the shadow maps, whose own files read the view that shading reads.
declare -A besides=([shading/shade_hits.isa.cpp]="shading/shadow")
# The part of scene/ that reads and writes files.
file_reader='^scene/(gltf|images)/'
status=0 seen=0
complain() { echo "$*"; status=1; }

while read -r file header kind; do
  seen=$((seen + 1))
  room=${file%%/*}
  edge=no
  if [[ $room == compare || $room == app || $file =~ $file_reader ]]; then edge=yes; fi
  if [[ $kind == q ]]; then
    [[ -f $header ]] || complain "$file: includes \"$header\"; expected a path from the root"
    [[ " ${sees[$room]} " == *" ${header%%/*} "* ]] || complain "$file: includes \"$header\"; $room sees only: ${sees[$room]}"
    folder=${file%/*} other=${header%/*}
    if [[ $folder != "$other" && ${header%%/*} == "$room" ]]; then
      allowed=" ${folders[$folder]-} ${besides[$file]-} "
      if [[ ! -v folders[$folder] ]]; then
        complain "$file: includes \"$header\"; expected $folder in the table of folders"
      elif [[ $allowed != *" $other "* && $allowed != *" $header "* ]]; then
        complain "$file: includes \"$header\"; $folder sees only: ${folders[$folder]:-no other folder of $room}"
      fi
    fi
    if [[ $edge == no && $header =~ $file_reader ]]; then
      complain "$file: includes \"$header\"; only the edges read files"
    fi
  else
    case $file:$header in
      core/wide/*:immintrin.h | core/wide/*:arm_neon.h) ;;
      core/float_mode.cpp:immintrin.h | core/float_mode.cpp:xmmintrin.h) ;;
      core/vec.h:glm/* | core/matrix.h:glm/*) ;;
      core/digest.cpp:xxhash.h | core/thread_pool.cpp:sched.h) ;;
      *:*mmintrin.h | *:immintrin.h | *:arm_neon.h) complain "$file: includes <$header>; intrinsics belong in core/wide" ;;
      *:*[./]*) [[ $edge == yes ]] || complain "$file: includes <$header>; expected the standard library only" ;;
    esac
  fi
done < <(includes)
if (( seen < 20 )); then complain "found $seen includes only"; fi
exit $status
