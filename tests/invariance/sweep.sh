#!/bin/bash
# sweep.sh REFERENCE DIRECTORY NAME RUNNER...: every ISA x thread count x tile size of one build of a digest tool.
#
#   REFERENCE  digests that all must print; made from the first configuration where it is not there yet
#   DIRECTORY  where outputs that differ are left
#   NAME       of the build, for messages
#   RUNNER     digest_tool or asset_digest_tool, or an emulator and one of them
# SHOAL_SWEEP=short tries the corners only, for builds that are slow.
set -euo pipefail
reference=$1 directory=$2 name=$3
shift 3
made=$directory/$name
rm -rf "$made"
mkdir -p "$made"

threads=(1 2 7) tiles=(32 64 128)
if [[ ${SHOAL_SWEEP:-} == short ]]; then threads=(1 7) tiles=(32 128); fi
mapfile -t isas < <("$@" --list-isas)
comma() { local IFS=,; echo "$*"; }

runs=0 failures=0
"$@" --isa "$(comma "${isas[@]}")" --threads "$(comma "${threads[@]}")" --tile "$(comma "${tiles[@]}")" --out "$made" ||
  { failures=1; echo "FAILED $name: the program stopped"; }
for isa in "${isas[@]}"; do
  for thread in "${threads[@]}"; do
    for tile in "${tiles[@]}"; do
      runs=$((runs + 1))
      out=$made/$isa-$thread-$tile
      configuration="$name --isa $isa --threads $thread --tile $tile"
      if [[ ! -s $out ]]; then
        failures=$((failures + 1))
        echo "FAILED $configuration: no digests"
      elif [[ ! -f $reference ]]; then
        mv "$out" "$reference"
      elif cmp -s "$reference" "$out"; then
        rm -f "$out"
      else
        failures=$((failures + 1))
        echo "DIFFERS $configuration: $(diff "$reference" "$out" | sed -n 2p)"
      fi
    done
  done
done
echo "$name: $runs configurations, $failures differ from $reference"
(( runs > 0 && failures == 0 ))
