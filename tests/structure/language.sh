#!/bin/bash
# shellcheck disable=SC2016 # awk programs and expressions hold $ and backquotes
# Code, comments, messages and documents use the terms of docs/GLOSSARY.md.
#
#   language.sh [--list]      --list prints what is left, a count for each room and rule, instead of every line
#
# Three checks: no rejected identifier in code, no rejected phrase in code, comments, messages or documents, and no line of a
# document longer than 120 columns. Each row of the two tables is
#
#   where :: what is rejected (extended regular expression) :: an example that it rejects :: what to write instead
#
# `where` is an extended regular expression for the file's path. The script checks itself first: each expression must reject its
# example and must not reject the replacement.
set -uo pipefail
export LC_ALL=C.UTF-8

any='.'
# Files in which a chunk is one of a file format: GLB, PNG, RIFF.
no_chunks='^(core|raster|shading|water|trace|refraction|compare|bench)/|^scene/(scene|animation)\.h|^scene/(build|procedural)/|^tests/(raster|shading|trace|refraction|invariance)/'
pipeline='^(raster|shading|trace|refraction|bench)/|^tests/(raster|shading|trace|refraction)/'

# Not shading/environment/, where masking is the term for facets that hide others.
alpha='^(raster|trace|refraction|bench)/|^shading/(material|surface|textures|shadow)|^tests/(raster|trace|refraction)/'

identifiers="
$any :: TriangleTree :: TriangleTree :: Bvh16
$any :: Beams? :: Beam :: PacketFrustum
$any :: look|looks|look_again|follow_again|looks_far :: look_again :: trace_secondary_interfaces
$any :: layer_tells :: layer_tells :: visibility_layer_valid
$any :: meet_water|meets_water :: meet_water :: trace_secondary_interfaces
$any :: ShadeBefore[A-Za-z]*|kShadesBefore|shades?_(before|after) :: ShadeBeforeStages :: ImageSpaceStages
$any :: mirrored_pass :: mirrored_pass :: planar_reflection_pass
$any :: kTruth|kWhole|kReal :: kTruth :: kBool
$no_chunks :: Chunks?|chunks?|[a-z_]*_chunks?|chunks?_[a-z_]+ :: chunk_outside :: meshlet_outside
$pipeline :: items?|BinItem|[a-z_]*per_item :: item :: work_item
$alpha :: masked|is_masked|masked_[a-z]+ :: masked :: alpha_tested
"

# The same, but of a member and its use, not of every variable of that name.
members="
^(raster|shading|trace|refraction)/ :: (float>?|WideF|F) keep\b|(layer|over|sum|out|blend|blended)\.keep\b :: over.keep :: over.transmittance
^(refraction|app)/ :: option[a-z_]*(\.|->)(standard|least|most)\b|char ?\* ?standard\b|float least, most\b :: option.least :: option.min
"

phrases="
$any :: scenes?( itself)? is asked|ask(s|ed|ing)? the scene|asks? the tree :: the scene itself is asked :: the BVH is traversed
$any :: layers? (cannot |can )?tells? :: the layer tells :: the visibility layer is valid
$any :: tree of boxes :: a tree of boxes :: a BVH
$any :: beams? of rays :: a beam of rays :: a packet frustum
$any :: (meet|meets|met|meeting) (the )?water (again|a second time) :: meets water again :: crosses a secondary water interface
$any :: looks? again :: looks again :: crosses a secondary water interface
$any :: [Tt]he truth\b :: the truth :: the reference
$any :: shad(es?|ing) (before|after)\b :: shades before :: image-space method
$any :: mirrored pass :: the mirrored pass :: the planar reflection pass
$any :: masked materials? :: a masked material :: an alpha-tested material
$any :: (//|\.) Of (a|an|the) [a-z]+(('s)|s')\b :: // Of a body's :: // The bounds of a body
$any :: What (a|the) pixel shows[.,:;]?\$ :: // What a pixel shows. :: The primitive that a pixel shows.
^README|^docs/([^g]|getting|decisions|tutorials) :: \b[Cc]hunks?\b :: a chunk :: a meshlet
^README|^docs/ :: the method has come|\b[Tt]ruth\b :: until the method has come :: the reference
$any :: DESIGN\.md|DESIGN [0-9] :: DESIGN.md :: the page in docs/ that says it
"

# Exempt: the page that lists the old words beside the new ones, the history, the log of goldens, and this file.
exempt='^(docs/GLOSSARY\.md|CHANGELOG\.md|tests/goldens/LOG\.md|tests/structure/language\.sh)$'
code='^(core|raster|shading|water|scene|trace|refraction|compare|library|app|bench|tests|viewer|python|include)/.*\.(h|cpp|def|in)$'
texts='^(README|CONTRIBUTING)\.md$|^(data|docs)/.*\.md$|^(core|raster|shading|water|scene|trace|refraction|compare|library|app|bench|tests|viewer|python|include|cmake|scripts)/'

list=no
if [[ ${1:-} == --list ]]; then list=yes; fi
status=0
left=()

mapfile -t files < <({ git ls-files 2>/dev/null || find . -type f -not -path './build/*' -not -path './out/*' | sed 's,^\./,,'; } |
  grep -vE '\.(png|glb|gltf|exr|hdr|jpg|bin)$|^tests/fuzz/' | grep -vE "$exempt")
# Lines PATH:NUMBER:TEXT of the code without comments and strings, and of all texts.
code_lines=$(printf '%s\n' "${files[@]}" | grep -E "$code" | xargs awk '
  { line = $0; gsub(/"([^"\\]|\\.)*"/, "\"\"", line); sub(/\/\/.*/, "", line); if (line ~ /[^ ]/) print FILENAME ":" FNR ":" line }')
text_lines=$(printf '%s\n' "${files[@]}" | grep -E "$texts" | xargs awk '/[^ ]/ { print FILENAME ":" FNR ":" $0 }')
if (( $(wc -l <<<"$code_lines") < 10000 || $(wc -l <<<"$text_lines") < 10000 )); then
  echo "language.sh: found too little to read; expected the sources of Shoal"
  exit 1
fi

# reject KIND LINES WHERE REGEX WHOLE INSTEAD
reject() {
  local where=$3 regex=$4 instead=$6 found
  if [[ $5 == whole ]]; then regex="(^|[^A-Za-z0-9_])($regex)([^A-Za-z0-9_]|\$)"; fi
  # All lines first, which is fast; then the path, and the text alone, because a path may hold the expression too.
  found=$(grep -E -- "$regex" <<<"$2" | awk -F: -v where="$where" '$1 ~ where' |
    while IFS= read -r line; do
      text=${line#*:*:}
      if [[ $text =~ $regex ]]; then printf '%s\n' "$line"; fi
    done)
  [[ -n $found ]] || return 0
  status=1
  if [[ $list == yes ]]; then
    while IFS= read -r line; do left+=("$(cut -d: -f1 <<<"$line" | cut -d/ -f1) :: $1 $4 -> $instead"); done <<<"$found"
  else
    printf '%s\n' "$found" | sed "s,\$,   <- $1; write \"$instead\","
  fi
}

# table KIND LINES TABLE WHOLE
table() {
  local where regex example instead probe
  while IFS= read -r row; do
    [[ -n $row ]] || continue
    where=${row%% :: *}; row=${row#* :: }
    regex=${row%% :: *}; row=${row#* :: }
    example=${row%% :: *}; instead=${row#* :: }
    probe=$regex
    if [[ $4 == whole ]]; then probe="(^|[^A-Za-z0-9_])($regex)([^A-Za-z0-9_]|\$)"; fi
    if ! [[ $example =~ $probe ]]; then echo "language.sh: '$regex' does not reject its example '$example'"; status=1; fi
    if [[ $instead =~ $probe ]]; then echo "language.sh: '$regex' rejects its replacement '$instead'"; status=1; fi
    reject "$1" "$2" "$where" "$regex" "$4" "$instead"
  done <<<"$3"
}
table identifier "$code_lines" "$identifiers" whole
table member "$code_lines" "$members" part
table phrase "$text_lines" "$phrases" part

# Documents keep to 120 columns.
while IFS= read -r file; do
  while IFS=: read -r number _; do
    status=1
    if [[ $list == yes ]]; then left+=("${file%%/*} :: $file: longer than 120 columns")
    else echo "$file:$number: longer than 120 columns"; fi
  done < <(grep -nE '^.{121,}$' "$file")
done < <(printf '%s\n' "${files[@]}" CHANGELOG.md docs/GLOSSARY.md | grep -E '\.md$' | sort -u | xargs ls -d 2>/dev/null)

if (( ${#left[@]} > 0 )); then printf '%s\n' "${left[@]}" | sort | uniq -c; fi
exit $status
