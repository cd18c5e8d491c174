#!/bin/bash
# Files aim for 300 lines and stop at 600.
set -uo pipefail
status=0
while IFS= read -r file; do
  lines=$(wc -l <"$file")
  if (( lines > 600 )); then
    echo "$file: $lines lines; files stop at 600"
    status=1
  fi
done < <(find CMakeLists.txt cmake core raster shading water scene trace refraction compare app bench tests scripts \
  \( -name '*.h' -o -name '*.cpp' -o -name '*.def' -o -name '*.cmake' -o -name '*.sh' -o -name CMakeLists.txt -o -path 'scripts/*' \) -type f)
exit $status
