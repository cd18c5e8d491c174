#!/bin/bash
# Stage digests of the files of data/assets/, in the place of digest_tool (sweep.sh): for what only a file can hold.
#
#   asset_digests.sh SHOAL --isa NAME --threads N --tile N
#   asset_digests.sh SHOAL --list-isas
set -euo pipefail
shoal=$1
shift
if [[ ${1:-} == --list-isas ]]; then
  "$shoal" list isas | awk '{ print $1 }'
  exit
fi
root=$(dirname "${BASH_SOURCE[0]}")/../..
while read -r asset camera time; do
  echo "$asset $camera $time"
  methods=(two-phase)
  # The reference on materials, on motion and on water.
  case "$asset $camera" in "materials front" | "motion rider" | "water above") methods+=(ray-traced) ;; esac
  for method in "${methods[@]}"; do
    "$shoal" render "$root/data/assets/$asset.glb" --camera "$camera" --time "$time" --method "$method" --size 160x90 \
      --shadow-map 512 --quiet --digest "$@"
  done
done <"$root/tests/goldens/assets.list"
