#!/usr/bin/env bash
# The checks of `./dev lint [tidy]`:  lint.sh BUILD_FOLDER [tidy]  (with compile_commands.json)
# and its repair:              lint.sh --format
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Homebrew keeps LLVM's tools out of the way of Apple's.
if command -v brew >/dev/null; then PATH=$PATH:$(brew --prefix)/opt/llvm/bin; fi

# Tracked files and new ones, but none that git ignores or that are deleted. Each ends with a newline.
sources() {
  git ls-files --cached --others --exclude-standard -- "$@" | sort -u |
    while read -r file; do if [ -f "$file" ]; then printf '%s\n' "$file"; fi; done
}

failed=""
check() {  # check WHAT COMMAND...
  local what=$1 start=$SECONDS
  shift
  if "$@"; then
    printf 'lint: %-28s fine   (%d s)\n' "$what" $((SECONDS - start))
  else
    printf 'lint: %-28s FAILED\n' "$what"
    failed="$failed, $what"
  fi
}

layout() {
  sources '*.h' '*.cpp' | xargs clang-format --dry-run -Werror
}

# kernels <- runtime -> scheduler; simulation -> all three; apps -> simulation. Scheduler is the
# standard library and itself. Includes are written from the project's root. A folder that has a row
# of its own may include what the row says; files that lie beside folders may include all of these.
include_directions() {
  local folder allowed wrong=0
  while read -r folder allowed; do
    sources "$folder/*.h" "$folder/*.cpp" | xargs -r grep -nHE '^ *# *include +"' |
      grep -vE "include +\"($allowed)[/\"]" && wrong=1
  done <<'TABLE'
kernels    kernels
scheduler  scheduler|weft/version.h
runtime    kernels|scheduler|runtime
runtime/io kernels|runtime/error.h|runtime/io
simulation kernels|scheduler|runtime|simulation
simulation/mesh      runtime|simulation/mesh
simulation/topology  scheduler/assert.h|runtime|simulation/topology
simulation/scene     runtime|simulation/(mesh|scene|element_families.h)
simulation/bodies    runtime|simulation/(mesh|scene|bodies)
simulation/families  kernels|scheduler/assert.h|runtime|simulation/(mesh|scene|bodies|topology|families|element_families.h)
simulation/model     kernels|runtime|simulation/(mesh|scene|bodies|topology|families|model)
simulation/contact   kernels|scheduler/assert.h|runtime|simulation/(mesh|scene|topology|families|model|solver|contact)
simulation/solver    kernels|scheduler/(assert|exchange_map).h|runtime|simulation/(mesh|scene|topology|families|model|contact|solver)
simulation/state     runtime|simulation/(families/convert.h|model|solver|output/(checkpoint|state_hash).h|state)
simulation/checks    kernels|runtime|simulation/(mesh|scene|bodies|topology|families|model|contact|solver|state|checks)
simulation/reference kernels|runtime|simulation/(mesh|scene|topology|families|model|contact|reference)
simulation/description runtime|simulation/(scene|bodies|families|model|solver|state|description)
simulation/run       kernels|scheduler/plan.h|runtime|simulation/(mesh|scene|model|contact|solver|state|checks|output|run|choice/tolerance_advice.h)
simulation/choice    scheduler/(in_order|timetable).h|runtime|simulation/(scene|model|solver|checks|run|choice|simulation.h)
simulation/output    scheduler/order_statistics.h|runtime|simulation/(reference|output)
apps       kernels|scheduler|runtime|simulation|apps
weft       kernels|scheduler|runtime|simulation
TABLE
  # A header of the standard library has neither a dot nor a slash in its name.
  sources 'scheduler/*.h' 'scheduler/*.cpp' | xargs -r grep -nHE '^ *# *include +<[^>]*[./]' &&
    wrong=1
  if [ $wrong -ne 0 ]; then
    echo 'These files include what their layer may not know (docs/architecture.md).' >&2
    return 1
  fi
}

# Every kernel as OpenCL C 1.2, without a device. Kernels are the headers on top of platform.h.
kernels_as_opencl() {
  local clang file as_functions wrong=0
  clang=$(command -v clang || command -v clang-14) || { echo 'clang is missing' >&2; return 1; }
  # Apple's clang lacks OpenCL's built-in header; Homebrew's has it.
  if [ -x "$(brew --prefix 2>/dev/null)/opt/llvm/bin/clang" ]; then
    clang=$(brew --prefix)/opt/llvm/bin/clang
  fi
  # What the program's text has as functions already (runtime/opencl/entry_points.cpp).
  as_functions=$(mktemp)
  cat >"$as_functions" <<'MACROS'
#pragma clang system_header
#define WEFT_KERNEL(name, ...) WEFT_INLINE void name(item i, __VA_ARGS__)
#define WEFT_NARROW_KERNEL WEFT_KERNEL
MACROS
  for file in $(sources 'kernels/*.h' | xargs grep -l '^#include "kernels/platform.h"'); do
    "$clang" -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -include "$as_functions" -fsyntax-only -I . \
      -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion -Wdouble-promotion -Werror \
      -Wno-unused-function -Wno-pragma-once-outside-header "$file" || wrong=1
  done
  rm "$as_functions"
  return $wrong
}

# clang-tidy on what has changed since it last found nothing; on everything in a fresh clone.
likely_mistakes() {
  local database=$1 stamps=$1/.tidy
  mkdir -p "$stamps"
  if [ .clang-tidy -nt "$stamps/rules" ]; then rm -f "$stamps"/*.ok; touch "$stamps/rules"; fi
  export database stamps
  sources '*.cpp' | grep -E '^(kernels|scheduler|runtime|simulation|apps)/' |
    xargs -P "$(getconf _NPROCESSORS_ONLN)" -n 1 bash -c '
      stamp=$stamps/${0//\//-}.ok
      if [ "$stamp" -nt "$0" ]; then exit 0; fi
      grep -q "/$0\"" "$database/compile_commands.json" || exit 0   # not built on this system
      if findings=$(clang-tidy --quiet -p "$database" "$0" 2>&1); then
        touch "$stamp"
      else
        printf "%s\n" "$findings" | grep -v "warnings generated"
        exit 1
      fi'
}

if [ "${1:-}" = --format ]; then
  sources '*.h' '*.cpp' | xargs clang-format -i
  exit
fi

check 'layout (./dev format)' layout
check 'include directions' include_directions
check 'kernels as OpenCL C 1.2' kernels_as_opencl
if [ "${2:-}" = tidy ]; then check 'likely mistakes (clang-tidy)' likely_mistakes "$1"; fi
if [ -n "$failed" ]; then
  echo "lint: failed: ${failed#, }"
  exit 1
fi
