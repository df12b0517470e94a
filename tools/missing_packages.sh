#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Prints the packages that a list names for some users and that are not installed, one a line.
#   tools/missing_packages.sh packages.txt build test
set -euo pipefail
list=$1
shift
awk -v users=" $* " '!/^#/ && NF && index(users, " " $2 " ") { print $1 }' "$list" |
  while read -r package; do
    status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null) || true
    [[ $status == "install ok installed" ]] || echo "$package"
  done
