#!/bin/bash
# same.sh MAKE_ASSETS: data/assets/ holds what the program writes, byte for byte, and nothing else.
set -uo pipefail
make_assets=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit 1
made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT
"$make_assets" "$made" && diff -rq "$made" data/assets
