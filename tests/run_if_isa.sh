#!/bin/bash
# run_if_isa.sh ISA COMMAND...: runs the command, or exits 77 where this machine cannot run ISA.
isa=$1
shift
case $isa in
  sse42) need="sse4_2 popcnt" ;;
  avx2) need="avx2 bmi2 fma" ;;
  avx512) need="avx512f avx512bw avx512dq avx512vl avx512cd" ;;
  *) need="" ;;
esac
flags=" $(grep -m1 '^flags' /proc/cpuinfo) "
for flag in $need; do
  if [[ $flags != *" $flag "* ]]; then
    echo "skipped: this machine has no $flag"
    exit 77
  fi
done
exec "$@"
