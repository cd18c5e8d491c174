#!/bin/bash
# no_libm_calls.sh NM ARCHIVE...: the objects call no function of libm whose last bit depends on the machine.
set -uo pipefail
nm=$1
shift
calls=$("$nm" -u "$@" | awk '$1 == "U" { print $2 }' | sort -u | sed 's/@.*//' |
  grep -xE '(a?sinh?|a?cosh?|a?tanh?|atan2|sincos|exp2?|exp10|expm1|log(2|10|1p|b)?|pow|cbrt|hypot|fmod|remainder|remquo|fma|erfc?|[lt]gamma)[fl]?')
if [[ -n $calls ]]; then
  echo "called: $calls"
  echo "libm differs between machines; core/math.h has ours"
  exit 1
fi
