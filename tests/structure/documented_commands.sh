#!/bin/bash
# documented_commands.sh SHOAL: the commands that README.md, CONTRIBUTING.md and docs/ show do exist.
#
# Looked at: lines of ```sh blocks that begin with scripts/... (the file is there and takes the options), or with
# build/release/bin/shoal or shoal (the subcommand is there, and so is each --option).
set -uo pipefail
shoal=$1
status=0 seen=0
complain() { echo "$*"; status=1; }

declare -A help
while IFS= read -r entry; do
  file=${entry%%:*}
  line=${entry#*:}
  line=${line%%#*}
  read -r -a words <<<"$line"
  case ${words[0]:-} in
    scripts/*)
      seen=$((seen + 1))
      [[ -x ${words[0]} ]] || { complain "$file: ${words[0]} is no script here"; continue; }
      for word in "${words[@]:1}"; do
        [[ $word != --?* ]] || grep -q -- "${word%%=*}" "${words[0]}" || complain "$file: ${words[0]} has no $word"
      done
      ;;
    shoal | build/release/bin/shoal)
      seen=$((seen + 1))
      sub=${words[1]:-}
      if [[ -z ${help[$sub]:-} ]]; then
        help[$sub]=$("$shoal" "$sub" --help 2>&1) || { complain "$file: '$line': shoal has no $sub"; continue; }
      fi
      for word in "${words[@]:2}"; do
        if [[ $word == --?* ]] && ! grep -qE -- "(^|[ ,])${word%%=*}([ ,=]|$)" <<<"${help[$sub]}"; then
          complain "$file: '$line': shoal $sub has no ${word%%=*}"
        fi
      done
      ;;
  esac
done < <(for file in README.md CONTRIBUTING.md docs/*.md docs/*/*.md; do
  [[ -f $file ]] && awk -v file="$file" '/^ *```/ { inside = ($0 ~ /```sh/) && !inside; next } inside { sub(/^ +/, ""); print file ":" $0 }' "$file"
done)
if (( seen < 5 )); then complain "found $seen commands only"; fi
exit $status
