# Shared by the scripts beside it; sourced, not run.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

say() { printf '\n== %s\n' "$*"; }
fail() { printf '%s: %s\n' "$(basename "$0")" "$*" >&2; exit 1; }
wrong_usage() { printf '%s: %s\n' "$(basename "$0")" "$*" >&2; exit 2; }

# As many compilers at once as there are processors and memory for: a kernel file needs up to 1.5 GB.
jobs() {
  local processors memory
  processors=$(nproc)
  memory=$(awk '/^MemAvailable/ { print int($2 / 1500000) }' /proc/meminfo)
  if (( memory < processors )); then processors=$memory; fi
  if (( processors < 1 )); then processors=1; fi
  echo "$processors"
}

# build PRESET [TARGET...]: configures where that is needed, and builds.
build() {
  local preset=$1
  shift
  say "build/$preset"
  if [[ ! -f build/$preset/build.ninja ]]; then
    local log
    # shellcheck disable=SC2086 # several arguments on purpose
    log=$(cmake --preset "$preset" ${SHOAL_CMAKE_ARGS:-} 2>&1) || { printf '%s\n' "$log" >&2; fail "cmake --preset $preset failed"; }
  fi
  cmake --build --preset "$preset" -j "$(jobs)" ${@:+--target "$@"}
}
