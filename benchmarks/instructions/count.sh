#!/usr/bin/env bash
# SPDX-FileCopyrightText: picolo contributors
# SPDX-License-Identifier: Apache-2.0
# Instructions of the kernels, counted by callgrind (Debian package valgrind): they do not vary as times do.
#   benchmarks/instructions/count.sh [BUILD]      BUILD defaults to build/host-release; with build/host-avx2 the AVX2 kernels
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
program=${1:-$root/build/host-release}/benchmarks/kernels
command -v valgrind >/dev/null || { echo "count.sh: no valgrind; apt-get install valgrind" >&2; exit 4; }
[[ -x $program ]] || { echo "count.sh: $program is not built; build the target 'kernels'" >&2; exit 3; }

counted() {
  valgrind --tool=callgrind --callgrind-out-file=/dev/null "$program" "$1" "$2" 2>&1 >/dev/null |
    sed -n 's/.*Collected : //p'
}
points=$("$program" sums 1 | cut -d ' ' -f 1)
row() { # NAME TIMES DIVISOR UNIT
  local few many
  few=$(counted "$1" 1)
  many=$(counted "$1" $((1 + $2)))
  printf '%-8s %12d instructions %s\n' "$1" $(((many - few) / ($2 * $3))) "$4"
}
row floor 50 "$points" "a point (the floor kernel)"
row sums 50 "$points" "a point and iteration"
row match 10 1 "a match of $points points"
row search 5 1 "a correlative search of +-0.5 m, +-30 deg"
row scan 10 1 "a scan of $points points: match and map update"
