#!/bin/bash
# compile_flags.sh COMPILE_COMMANDS: every translation unit has the flags that the contract needs, none has fast-math.
set -uo pipefail
if [[ ! -f $1 ]]; then echo "$1 is missing; expected CMAKE_EXPORT_COMPILE_COMMANDS=ON, as the presets have it"; exit 1; fi
commands=$(grep '"command":' "$1")
if [[ -z $commands ]]; then echo "$1: no commands"; exit 1; fi
status=0
without=$(grep -vc -- '-ffp-contract=off' <<<"$commands")
if (( without > 0 )); then
  echo "$without translation units without -ffp-contract=off:"
  grep -v -- '-ffp-contract=off' <<<"$commands" | sed 's/.* -c /  /'
  status=1
fi
if grep -E -- '-Ofast|-ffast-math|-funsafe-math|-fassociative-math|-freciprocal-math|-ffinite-math|-mfma\b|-march=native' <<<"$commands"; then
  echo "flags that change results"
  status=1
fi
exit $status
