#!/bin/bash
# Code that reaches a pixel uses GLM's types and the operations of GLM that tests/core/test_glm.cpp lists, and no other.
#
# core/vec.h and core/matrix.h alone include GLM, and only headers of its vector and matrix types. No room names a
# function of GLM. Nothing sets GLM_FORCE_INTRINSICS, which changes the order of GLM's operations.
set -uo pipefail
rooms=(core raster shading water scene trace refraction)
status=0
complain() { echo "$*"; status=1; }

code=$(find "${rooms[@]}" \( -name '*.h' -o -name '*.cpp' \) | LC_ALL=C sort |
  xargs awk '{ sub(/\/\/.*/, ""); print FILENAME ":" FNR ": " $0 }')

types='[biud]?vec[234]|d?mat[234](x[234])?|vec|mat|length_t|qualifier|defaultp'
names=$(grep -oE '^[^ ]+ |glm::[A-Za-z_0-9]+' <<<"$code" | awk '/ $/ { at = $1; next } { print at, $0 }')
if (( $(wc -l <<<"$names") < 10 )); then complain "found too few uses of GLM"; fi
while read -r at name; do
  [[ $name =~ ^glm::($types)$ ]] || complain "$at $name is not one of GLM's types; write the expression out"
done <<<"$names"

while IFS= read -r line; do
  [[ $line =~ ^core/(vec|matrix)\.h:[0-9]+:.*\<glm/(vec[234]|mat[234]x[234])\.hpp\> ]] ||
    complain "$line; expected core/vec.h or core/matrix.h to include a type of GLM"
done < <(grep -E '#[[:space:]]*include[[:space:]]*[<"]glm/' <<<"$code")
while IFS= read -r line; do
  complain "$line; expected names of GLM to be written with glm::"
done < <(grep -E 'using[[:space:]]+(namespace[[:space:]]+glm|glm::)' <<<"$code" | grep -vE 'using[[:space:]]+[A-Za-z0-9]+[[:space:]]*=')

forced=$(grep -rlE 'GLM_FORCE_(INTRINSICS|SSE|AVX|NEON|PURE|DEFAULT_ALIGNED|ALIGNED|SWIZZLE|CTOR_INIT|XYZW)' \
  CMakeLists.txt CMakePresets.json cmake "${rooms[@]}" app bench compare tests scripts | grep -v '^tests/structure/glm_functions\.sh$')
[[ -z $forced ]] || complain "a setting of GLM that changes its types or arithmetic is named in: $forced"
exit $status
