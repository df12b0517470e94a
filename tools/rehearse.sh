#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The whole chain without hardware:  tools/rehearse.sh BUILD FOLDER SECONDS [FLAGS OF simulate --live]
# Simulated devices send live over loopback, the nodes through a radio that delays and loses; they are
# recorded, aligned, and held against the truth. FOLDER is new. Ends with 1 where a certified stamp
# lies outside its interval.
set -euo pipefail
build=$1 folder=$2 seconds=$3
kinalign=$build/apps/kinalign/kinalign
[[ ! -e $folder ]] || { echo "rehearse.sh: $folder is there already: name a new folder" >&2; exit 3; }

"$kinalign" simulate built-in -o "$folder" --live --begin-in 2 --seconds "$seconds" --quiet "${@:4}" &
simulation=$!
# Whatever ends this, nobody goes on sending.
trap 'kill "$simulation" 2>/dev/null && wait "$simulation" || true' EXIT
until [[ -e $folder/lab.toml ]]; do
  kill -0 "$simulation" 2>/dev/null || wait "$simulation"
  sleep 0.05
done
echo "rehearsing live for $seconds s: a suit, a Kinect and five nodes over loopback"
"$kinalign" record -o "$folder" --config "$folder/lab.toml" --seconds $((seconds + 3)) --quiet
wait "$simulation"
trap - EXIT

"$kinalign" align "$folder/recording.toml" -o "$folder/take.h5" || (($? == 1)) # 1: with warnings
"$build/tools/kinalign_truth_table" "$folder/recording.toml" "$folder/take.h5" "$folder/truth/truth.json"
