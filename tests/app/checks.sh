# Checks for scripts that run the command as a user does. Source it; then call `finish` at the end.
#
#   shoal           the command, an absolute path
#   work            an empty folder, removed at the end; the current one
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
shoal=${1:-${SHOAL_COMMAND:?expected the command as first argument or in SHOAL_COMMAND}}
shoal=$(realpath "$shoal")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
checks=0
failures=0

fail() {
  failures=$((failures + 1))
  echo "FAILED: $1"
  shift
  [ $# -eq 0 ] || printf '    %s\n' "$@"
}

# passes NAME COMMAND...: the command succeeds.
passes() {
  local name=$1
  shift
  checks=$((checks + 1))
  "$@" >"$work/.out" 2>"$work/.err" || fail "$name" "$* gave $?" "$(cat "$work/.err")"
}

# exits NAME CODE COMMAND...: that exit code; leaves .out and .err.
exits() {
  local name=$1 code=$2 got
  shift 2
  checks=$((checks + 1))
  "$@" >"$work/.out" 2>"$work/.err"
  got=$?
  [ "$got" = "$code" ] || fail "$name" "$* gave $got, not $code" "$(cat "$work/.err")"
}

# refuses CODE PATTERN COMMAND...: that exit code, nothing on standard output, and one line on standard error that begins
# as an error does and matches the extended pattern.
refuses() {
  local code=$1 pattern=$2 got
  shift 2
  checks=$((checks + 1))
  "$@" >"$work/.out" 2>"$work/.err" </dev/null
  got=$?
  if [ "$got" != "$code" ]; then
    fail "$*" "exit $got, not $code" "$(cat "$work/.err")"
  elif [ "$(wc -l <"$work/.err")" != 1 ] || ! grep -q '^shoal: error: ' "$work/.err"; then
    fail "$*" "not one line of error:" "$(cat "$work/.err")"
  elif ! grep -Eq -- "$pattern" "$work/.err"; then
    fail "$*" "no '$pattern' in:" "$(cat "$work/.err")"
  elif [ -s "$work/.out" ]; then
    fail "$*" "wrote to standard output:" "$(head -3 "$work/.out")"
  fi
}

# equals NAME WANT GOT
equals() {
  checks=$((checks + 1))
  [ "$2" = "$3" ] || fail "$1" "want: $2" "got:  $3"
}

# Top-level keys of an indented JSON file, in order, on one line.
keys_of() { grep -oE '^  "[^"]+"' "$1" | tr -d ' "' | paste -sd ' '; }

# no_leftovers NAME: nothing half-written in the work folder.
no_leftovers() { equals "$1: no partial file" "" "$(find "$work" -name '.shoal-*' | head -3)"; }

picture() { perl "$here/picture.pl" "$@"; }

finish() {
  echo "$checks checks, $failures failed"
  [ "$failures" = 0 ]
  exit
}
