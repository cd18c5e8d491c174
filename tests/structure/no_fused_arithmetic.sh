#!/bin/bash
# no_fused_arithmetic.sh OBJDUMP ARCHIVE...: no fused multiply-add and no approximate reciprocal is in the objects.
set -uo pipefail
objdump=$1
shift
x86='vfn?m(add|sub)[a-z0-9]*|v?rcp(14|28)?[ps][sd]|v?rsqrt(14|28)?[ps][sd]'
arm='fn?m(add|sub)|fml[as]l?2?|frecp[esx]|frsqrt[es]'
status=0
for archive in "$@"; do
  listing=$("$objdump" -d --no-show-raw-insn "$archive") || exit 1
  if [[ -z $listing ]]; then echo "$archive: nothing to look at"; status=1; fi
  if ! awk -v archive="$archive" -v bad="^($x86|$arm)\$" '
      /file format/ { object = $1 }
      /^[0-9a-f]+ </ { symbol = $2 }
      $1 ~ /^[0-9a-f]+:$/ && $2 ~ bad { print object " " symbol " " $2; if (++count == 20) exit }
      END { exit count > 0 }' <<<"$listing"; then
    echo "$archive: fused or approximate arithmetic; is -ffp-contract=off on this file?"
    status=1
  fi
done
exit $status
