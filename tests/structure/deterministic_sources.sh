#!/bin/bash
# Nothing whose result depends on the library, the compiler or the run is named in code that reaches a pixel.
set -uo pipefail
code=$(find core raster shading water scene trace refraction \( -name '*.h' -o -name '*.cpp' \) | grep -vE '^scene/(gltf|images)/' |
  LC_ALL=C sort | xargs awk '{ sub(/\/\/.*/, ""); print FILENAME ":" FNR ": " $0 }')
if (( $(wc -l <<<"$code") < 1000 )); then echo "found too little to look at"; exit 1; fi
status=0

# forbid WHY REGEX: comments do not count.
forbid() {
  if grep -E "$2" <<<"$code"; then
    echo "  $1"
    status=1
  fi
}

functions='a?sinh?|a?cosh?|a?tanh?|atan2|exp2?|expm1|log(2|10|1p|b)?|pow|cbrt|hypot|fmod|remainder|remquo|fma|lerp|erfc?|[lt]gamma'
forbid "libm differs between machines; core/math.h has ours" "(std|glm)::($functions)(f|l)?[[:space:]]*\("
forbid "libm differs between machines; core/math.h has ours" "(^|[^A-Za-z0-9_:.>])($functions)f[[:space:]]*\("
forbid "distributions differ between standard libraries" 'std::[a-z_]+_distribution'
forbid "the order of unordered containers differs between standard libraries" 'std::unordered_'
forbid "no run may depend on the clock or on a random device" 'std::(random_device|time\b|rand\b)'
forbid "atomic floats add up in the order of arrival" 'std::atomic<[[:space:]]*(float|double)'
forbid "sums whose order is the library's" 'std::(reduce|transform_reduce|execution)'
exit $status
