#!/bin/bash
# isa_isolation.sh OBJDUMP NM PROGRAM: code that every machine runs holds no instruction that only some have.
#
# A function outside of the kernels' namespaces that the linker took from an AVX object would stop an older machine
# (cmake/ShoalIsa.cmake). In the linked program: each function that is not local to one object and whose name is not of
# isa_avx2 or isa_avx512 must hold no VEX or EVEX instruction, nor one of BMI.
set -euo pipefail
objdump=$1 nm=$2 program=$3

header=$("$objdump" -f "$program")
if [[ $header != *x86-64* ]]; then
  echo "one instruction set on this architecture: nothing to isolate"
  exit 0
fi
# Symbols that are not local: text, weak, unique.
"$nm" --defined-only "$program" | awk '$2 ~ /^[TWVu]$/ { print $3 }' >"$program.symbols"
"$objdump" -d --no-show-raw-insn "$program" | awk -v symbols="$program.symbols" '
  BEGIN { while ((getline line < symbols) > 0) shared[line] = 1 }
  /^[0-9a-f]+ <.*>:$/ {
    name = substr($2, 2, length($2) - 3)
    looked_at = (name in shared) && name !~ /isa_avx2|isa_avx512/
    functions += looked_at
    if (name ~ /isa_avx2|isa_avx512/) kernels++
    next
  }
  looked_at && $1 ~ /^[0-9a-f]+:$/ && $2 ~ /^(v[a-z].*|(shlx|sarx|shrx|rorx|andn|bextr|blsi|blsr|blsmsk|bzhi|mulx|pdep|pext)[lq]?)$/ && $2 !~ /^ver[rw]$/ {
    if (!(name in told)) { told[name] = 1; bad++; if (bad <= 20) print name ": " $2 }
  }
  END {
    if (functions < 10 || kernels < 1) { print "found " functions " functions, " kernels " AVX kernels: is it stripped?"; exit 1 }
    if (bad) { print bad " functions outside of the kernels need AVX"; exit 1 }
    print functions " functions looked at, " kernels " AVX kernels left out"
  }'
