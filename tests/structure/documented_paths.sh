#!/bin/bash
# shellcheck disable=SC2016 # awk programs and expressions hold $ and backquotes
# Every file that a document names exists, and every link of a document leads somewhere.
#
#   documented_paths.sh [PAGE.md...]      all *.md files of the repository by default
#
# Checked in each page, outside of blocks of code:
# - links [text](path#heading): the file exists, and where a heading is named, the page has it;
# - `paths` in backquotes that begin with a folder of the repository (`raster/visibility.h`, `scripts/bench`), with a glob
#   pattern where they hold a *;
# - `names` of source files without a folder (`exact_ray.h`): one file of the repository has that name.
# Names with a placeholder (NAME, <room>, X, my_) are left out, and so are build/ and out/, which the build makes.
set -uo pipefail
export LC_ALL=C.UTF-8
status=0 seen=0
complain() { echo "$*"; status=1; }

mapfile -t files < <(git ls-files 2>/dev/null || find . -type f -not -path './build/*' -not -path './out/*' | sed 's,^\./,,')
declare -A name_of
for file in "${files[@]}"; do name_of[${file##*/}]=1; done
if (( $# > 0 )); then pages=("$@"); else mapfile -t pages < <(printf '%s\n' "${files[@]}" | grep '\.md$' | grep -v '/LOG\.md$'); fi
(( ${#pages[@]} > 0 )) || { echo "found no page"; exit 1; }
folders='core|raster|shading|water|scene|trace|refraction|compare|library|app|bench|tests|data|docs|scripts|cmake|include|viewer|python'

# The anchor that a heading gets: lower case, punctuation dropped, spaces as hyphens.
anchors() { grep -E '^#+ ' "$1" | sed -E 's/^#+ +//; s/`//g' | tr '[:upper:]' '[:lower:]' | sed -E "s/[^a-z0-9 _-]//g; s/ /-/g"; }

for page in "${pages[@]}"; do
  [[ -f $page ]] || { complain "$page: is not there"; continue; }
  folder=$(dirname "$page")
  text=$(awk '/^ *```/ { inside = !inside; next } !inside' "$page")
  while IFS= read -r target; do
    [[ -n $target && $target != *://* && $target != mailto:* ]] || continue
    seen=$((seen + 1))
    path=${target%%#*} heading=
    if [[ $target == *#* ]]; then heading=${target#*#}; fi
    if [[ -n $path ]]; then path=$folder/$path; else path=$page; fi
    if [[ ! -e $path ]]; then complain "$page: the link ($target) leads nowhere"; continue; fi
    if [[ -n $heading ]] && ! anchors "$path" | grep -qxF -- "$heading"; then
      complain "$page: the link ($target) names a heading that $path does not have"
    fi
  done < <(grep -oE '\]\([^) ]+\)' <<<"$text" | sed -E 's/^\]\(//; s/\)$//')
  while IFS= read -r word; do
    [[ ! $word =~ [A-Z]{2,}|[\<\>\{\}]|(^|/)[Xx]\.|my_ || $word == *README.md || $word == *.md ]] || continue
    if [[ $word =~ ^($folders)/ ]]; then
      seen=$((seen + 1))
      compgen -G "${word%/}" >/dev/null || complain "$page: there is no $word"
    elif [[ $word =~ ^[a-z0-9_]+\.(isa\.cpp|h|cpp|def|sh|cmake)$ ]]; then
      seen=$((seen + 1))
      [[ -n ${name_of[$word]:-} ]] || complain "$page: no file is named $word"
    fi
  done < <(grep -oE '`[^` ]+`' <<<"$text" | tr -d '`' | sed -E 's/:[0-9]+$//' | sort -u)
done
(( seen > 0 )) || complain "found no path and no link"
exit $status
