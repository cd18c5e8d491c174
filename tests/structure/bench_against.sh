#!/bin/bash
# bench_against.sh: bench/against_table decides as its rule says, on made values whose decision is known.
#
# The rule: the median ratio is off 1 by more than 1 %, and p < 0.01 in a two-sided sign test, whose values here are
# exact binomial ones: 11 of 11 pairs on one side 2/2048, 10 of 11 24/2048, 13 of 15 242/32768.
set -uo pipefail
status=0
complain() { echo "FAILED: $*"; status=1; }

# pairs ROW RATIO...: A is 10 ms, B is 10 ms times each ratio in turn.
pairs() {
  local row=$1 pair=0 ratio
  shift
  for ratio in "$@"; do
    pair=$((pair + 1))
    awk -v row="$row" -v pair=$pair -v ratio="$ratio" 'BEGIN { printf "%s,frame,%d,10,%.6f\n", row, pair, 10 * ratio }'
  done
}
# times COUNT RATIO
times() { local i; for (( i = 0; i < $1; ++i )); do printf '%s ' "$2"; done; }

# shellcheck disable=SC2046 # words on purpose
table=$(
  {
    echo row,measure,pair,a,b
    pairs equal $(times 11 1)
    pairs slower_all $(times 11 1.03)
    pairs faster_all $(times 11 0.97)
    pairs slower_10_of_11 $(times 10 1.03) 0.99
    pairs slower_13_of_15 $(times 13 1.03) 0.99 0.99
    pairs slower_little $(times 11 1.009)
    pairs wide $(times 6 1.5) $(times 5 0.5)
    pairs one_outlier $(times 10 1.0005) 3
    echo equal,picture,1,aa,aa
    echo wide,picture,1,aa,ab
    echo count_more,instructions,1,1000000,1002000
    echo count_equal,instructions,1,1000000,1000500
  } | bench/against_table table
) || complain "against_table gave $?"

# row NAME RATIO P VERDICT
row() {
  grep -qE "^\| $1 \| [a-z]+ \|[^|]*\|[^|]*\| $2 \|[^|]*\| $3 \| $4 \|\$" <<<"$table" ||
    complain "$1: expected ratio $2, p '$3', verdict '$4'; got: $(grep "^| $1 " <<<"$table")"
}
row equal 1.0000 1 ''
row slower_all 1.0300 0.00098 '\*\*more\*\*'
row faster_all 0.9700 0.00098 '\*\*less\*\*'
row slower_10_of_11 1.0300 0.012 ''
row slower_13_of_15 1.0300 0.0074 '\*\*more\*\*'
row slower_little 1.0090 0.00098 ''
row wide 1.5000 1 ''
row one_outlier 1.0005 0.00098 ''
row count_more 1.0020 '' '\*\*more\*\*'
row count_equal 1.0005 '' ''
grep -q '^- 4 of 10 rows changed beyond the noise: slower_all frame; ' <<<"$table" || complain "the summary: $table"
grep -q '^- The pictures of wide differ' <<<"$table" || complain "no word of the pictures that differ"
if grep -q 'pictures of equal' <<<"$table"; then complain "equal pictures are said to differ"; fi
exit $status
