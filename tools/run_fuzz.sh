#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the fuzz targets of build/fuzz, one a processor: run_fuzz.sh [TARGET...] [--minutes N]
# Seeds: the files that a target's line "// Seeds: bvh/*/*.bvh ..." names below ../shared/data (where
# it is there; longer ones cut to 64 KiB), and tests/data/fuzz/TARGET. What grows from them stays in
# build/fuzz/corpus. Prints executions and finds; fails where there are finds.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
shopt -s globstar nullglob
minutes=5 targets=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --minutes) minutes=$2 && shift 2 ;;
    *) targets+=("$1") && shift ;;
  esac
done
if [[ ${#targets[@]} -eq 0 ]]; then
  for program in build/fuzz/fuzz/*_fuzz; do targets+=("${program##*/}"); done
fi
[[ ${#targets[@]} -gt 0 ]] || { echo "no fuzz target in build/fuzz/fuzz" >&2 && exit 3; }

seeds() { # TARGET FOLDER
  local patterns=() pattern file n=0 # read, not expanded: they hold for ../shared/data, not for here
  read -ra patterns < <(sed -n 's|^// Seeds: *||p' "fuzz"/*/"$1.cpp" 2>/dev/null) || true
  for pattern in "${patterns[@]}"; do
    # shellcheck disable=SC2231 # the pattern shall be expanded
    for file in ../shared/data/$pattern; do
      n=$((n + 1))
      head -c 65536 "$file" >"$2/${n}_$(basename "$file")"
    done
  done
  for file in "tests/data/fuzz/$1"/*; do cp "$file" "$2/"; done
}

# The fuzzer limits wall time alone: it is started again until the processor's time is spent.
one() { # TARGET
  local corpus=build/fuzz/corpus/$1 seeds=build/fuzz/seeds/$1 found=build/fuzz/finds/$1 log=build/fuzz/$1.log
  rm -rf "$seeds" && mkdir -p "$corpus" "$seeds" "$found"
  seeds "$1" "$seeds"
  local TIMEFORMAT='%U %S' left=$((minutes * 60)) executions=0 cpu=0 spent finds
  : >"$log"
  while ((left > 0)); do
    { time "build/fuzz/fuzz/$1" -max_total_time="$left" -timeout=20 -rss_limit_mb=3072 -max_len=65536 \
      -print_final_stats=1 -artifact_prefix="$found/" "$corpus" "$seeds" >"$log.run" 2>&1; } 2>"$log.time" || left=0
    cat "$log.run" >>"$log"
    spent=$(awk '{print int($1 + $2)}' "$log.time")
    cpu=$((cpu + spent)) left=$((left - spent))
    executions=$((executions + $(sed -n 's/^stat::number_of_executed_units: *//p' "$log.run" | tail -1)))
  done
  rm -f "$log.run" "$log.time"
  finds=("$found"/*)
  printf '%-28s %12s executions  %6s CPU s  %s seeds  %s finds%s\n' "$1" "$executions" "$cpu" \
    "$(find "$seeds" -type f | wc -l)" "${#finds[@]}" "${finds[0]:+: $found, $log}"
  [[ ${#finds[@]} -eq 0 ]]
}

for target in "${targets[@]}"; do
  [[ -x build/fuzz/fuzz/$target ]] || { echo "no fuzz target $target; there are: $(cd build/fuzz/fuzz && echo *_fuzz)" >&2 && exit 2; }
done
failed=0 running=0
for target in "${targets[@]}"; do
  if ((running == $(nproc))); then
    wait -n || failed=1
    running=$((running - 1))
  fi
  one "$target" &
  running=$((running + 1))
done
while ((running-- > 0)); do wait -n || failed=1; done
exit "$failed"
