#!/bin/bash
# The oracle of the refracted picture shares no function with the renderer: it and what it includes read headers of plain
# data alone.
set -uo pipefail
allowed=" core/vec.h scene/hit_kind.h scene/scene.h water/surface_data.h "
status=0 seen=0
check() { # check FILE: its quoted includes, and those of the tests' own headers
  local file=$1 header path
  while read -r header; do
    seen=$((seen + 1))
    path=$header
    [[ -f $path ]] || path=$(realpath --relative-to=. "$(dirname "$file")/$header")
    if [[ $path == tests/* ]]; then
      check "$path"
    elif [[ $allowed != *" $path "* ]]; then
      echo "$file: includes \"$header\"; an oracle sees only:$allowed"
      status=1
    fi
  done < <(sed -nE 's/^ *# *include "([^"]+)".*/\1/p' "$file")
}
check tests/refraction/refraction_oracle.h
if (( seen < 4 )); then echo "found $seen includes only"; status=1; fi
exit $status
