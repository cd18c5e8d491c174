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

# machine FOLDER: what was measured on, as lines of Markdown; FOLDER is of a build, for its compiler.
machine() {
  local compiler
  compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[A-Z]*=//p' "$1/CMakeCache.txt")
  printf -- '- CPU: %s, %s of them\n' "$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1)" "$(nproc)"
  printf -- '- memory: %s\n' "$(awk '/^MemTotal/ { printf "%.1f GiB", $2 / 1048576 }' /proc/meminfo)"
  printf -- '- system: %s\n' "$(uname -srm)"
  printf -- '- compiler: %s\n' "$("${compiler:-c++}" --version | head -n 1)"
  printf -- '- load average at the start: %s\n' "$(cut -d ' ' -f 1-3 /proc/loadavg)"
}
