#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every check that is no test; build/dev must be built. clang-tidy sees the files that are not as
# they were when they passed: tools/tidy.py says which that are, also with --changed.
#   tools/checks.sh [--changed]
# shellcheck disable=SC2317 # the checks are called by name
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 3
failed=0

check() { # NAME COMMAND...
  local name=$1 out
  shift
  if out=$("$@" 2>&1); then
    echo "check $name: fine"
  else
    echo "check $name: failed"
    printf '%s\n' "$out" | tail -80
    failed=1
  fi
}

ours=(apps bench cmake firmware fuzz kinalign tests tools)

format() {
  find "${ours[@]}" \( -name '*.cpp' -o -name '*.h' \) -print0 |
    xargs -0 -r clang-format-14 --dry-run -Werror
}

licence() {
  local without
  without=$({
    printf '%s\0' dev .ci/run
    find "${ours[@]}" \( -name '*.cpp' -o -name '*.h' -o -name '*.py' -o -name '*.sh' -o -name '*.cmake' \) -print0
  } | xargs -0 grep -L 'SPDX-License-Identifier: Apache-2.0')
  [[ -z $without ]] || { echo "no SPDX line: $without" && return 1; }
}

# build/dev joins files; clang-tidy needs the command of each, which the preset `commands` has. It is never built.
tidy() {
  cmake --preset commands >build/configure_commands.log 2>&1 || { tail -20 build/configure_commands.log && return 1; }
  /usr/bin/python3 tools/tidy.py build/commands --jobs "$(nproc)" "$@"
}

check format format
check licence licence
check includes /usr/bin/python3 tools/check_includes.py
check comments /usr/bin/python3 tools/check_comments.py
check docs /usr/bin/python3 tools/check_docs.py build/dev/apps/kinalign/kinalign
check clang-tidy tidy "$@"
exit "$failed"
