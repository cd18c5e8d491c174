#!/bin/bash
# Goldens through the command, and goldens anew.
#
#   run.sh SHOAL GOLDEN_TOOL GROUP...   the groups are all of golden_tool's, every golden belongs to a frame of one, and
#                                       the command draws what golden_tool draws: of each group and of each method one
#                                       frame at least. (golden_tool GROUP compares all frames of a group.)
#   run.sh SHOAL GOLDEN_TOOL --update   draws with the command every frame that golden_tool finds changed, and keeps it
#                                       as the golden (scripts/update_goldens does this, and asks for the reason)
#
# A golden is NAME.txt, the digest of each stage, and NAME.png, the picture. There is no tolerance. A golden that is
# missing fails, and so does one that belongs to no scene, camera or method.
set -uo pipefail
shoal=$(realpath "${1:?usage: run.sh SHOAL GOLDEN_TOOL --update | GROUP...}")
tool=$(realpath "${2:?usage: run.sh SHOAL GOLDEN_TOOL --update | GROUP...}")
shift 2
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit
goldens=tests/goldens
out=out/goldens
mkdir -p $out
status=0
complain() { echo "$*"; status=1; }

if ! frames=$("$tool" --frames) || ! groups=$("$tool" --groups); then exit 1; fi

# strays: goldens that no frame has.
strays() {
  comm -13 <(awk '{ print $2 }' <<<"$frames" | LC_ALL=C sort -u) \
    <(find $goldens \( -name '*.txt' -o -name '*.png' \) ! -name CMakeLists.txt -printf '%f\n' | sed 's/\.[a-z]*$//' | LC_ALL=C sort -u)
}

# draw NAME METHOD ARGUMENT...: draws a frame: NAME.command.txt and NAME.command.png.
draw() {
  local name=$1 method=$2
  shift 2
  "$shoal" render "$@" --method "$method" --quiet --digest -o "$out/$name.command.png" </dev/null >"$out/$name.command.txt" ||
    complain "$name: the command did not draw it"
}

if [[ ${1:-} == --update ]]; then
  for group in $groups; do
    changed=$("$tool" "$group" --changed) || { complain "group $group: $changed"; continue; }
    while read -r word name method arguments; do
      case $word in
        '#') ;;
        removed)
          rm -f "$goldens/$name.txt" "$goldens/$name.png"
          echo "$name (removed)"
          ;;
        *)
          # shellcheck disable=SC2086  # arguments are words
          draw "$name" "$method" $arguments
          if ! cmp -s "$out/$name.txt" "$out/$name.command.txt"; then
            complain "$name: the command and golden_tool differ: $out/$name.command.txt, $out/$name.txt"
            continue
          fi
          mv "$out/$name.command.txt" "$goldens/$name.txt"
          mv "$out/$name.command.png" "$goldens/$name.png"
          rm -f "$out/$name".*
          echo "$name"
          ;;
      esac
    done <<<"$changed"
  done
  for name in $(strays); do
    rm -f "$goldens/$name.txt" "$goldens/$name.png"
    echo "$name (removed)"
  done
  exit $status
fi

[[ $* == $(tr '\n' ' ' <<<"$groups" | sed 's/ $//') ]] || complain "ctest compares the groups: $*; expected: ${groups//$'\n'/ }"
for name in $(strays); do complain "$name: belongs to no scene, camera or method"; done

# pick_frames: of each group a frame by a method that no other group's has, while there is one; then the first frame of
# each method that is left. The groups with the fewest frames choose first.
pick_frames() {
  awk -v folder=$goldens '
    { golden = folder "/" $2 ".txt"; if ((getline line <golden) < 0) next; close(golden) }  # not made for the scene
    { frame[++frames] = $0; group[frames] = $1; method[frames] = $3; ++size[$1] }
    END {
      while (1) {
        least = ""
        for (g in size) if (!(g in chosen) && (least == "" || size[g] < size[least] || size[g] == size[least] && g < least)) least = g
        if (least == "") break
        best = 0
        for (i = frames; i > 0; --i) if (group[i] == least && (!best || !(method[i] in drawn) || method[best] in drawn)) best = i
        chosen[least] = drawn[method[best]] = 1
        print frame[best]
      }
      for (i = 1; i <= frames; ++i) if (!(method[i] in drawn)) { drawn[method[i]] = 1; print frame[i] }
    }' <<<"$frames"
}

declare -A drawn
compared=0
while read -r group name method arguments; do
  drawn[group $group]=1 drawn[method $method]=1
  compared=$((compared + 1))
  # shellcheck disable=SC2086  # arguments are words
  draw "$name" "$method" $arguments
  if cmp -s "$goldens/$name.txt" "$out/$name.command.txt" &&
    "$shoal" diff --quiet "$goldens/$name.png" "$out/$name.command.png"; then
    rm -f "$out/$name.command".*
  else
    complain "$name: the command draws another frame: $out/$name.command.txt, .png"
  fi
done < <(pick_frames)
methods=$("$shoal" list methods | awk '!/not the same bytes/ { print $1 }')
for method in $methods; do [[ -n ${drawn[method $method]:-} ]] || complain "$method: no golden was drawn by the command"; done
for group in $groups; do [[ -n ${drawn[group $group]:-} ]] || complain "$group: no golden was drawn by the command"; done
echo "$compared frames drawn by the command"
exit $status
