#!/usr/bin/env bash
# SPDX-FileCopyrightText: picolo contributors
# SPDX-License-Identifier: Apache-2.0
# Every recorded log that has a reference, with the defaults: ATE rmse in metres after SE(2) alignment, and what it must not exceed.
#   benchmarks/accuracy/table.sh DATA [BUILD] [REPLAY ARGS...]      DATA: the folder with radish/ and raw2d/; exit 1 when a row misses
# Ten seconds on an idle core. REPLAY ARGS go to every `picolo replay`, e.g. --profile hall.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
data=${1:?"usage: table.sh DATA [BUILD] [REPLAY ARGS...]"}
picolo=${2:-$root/build/host-release}/apps/picolo/picolo
shift $(($# > 1 ? 2 : 1))
[[ -d $data/radish ]] || { echo "table.sh: $data has no folder radish" >&2; exit 3; }
[[ -x $picolo ]] || { echo "table.sh: $picolo is not built; build the target 'picolo_tool'" >&2; exit 3; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
missed=0

number() { # KEY JSON: rmse of the object KEY
  sed -n "s/.*\"$1\":{\"rmse\":\([0-9.eE-]*\).*/\1/p" <<<"$2"
}
row() { # NAME LIMIT ATE ODOMETRY
  local verdict=ok
  awk "BEGIN { exit !($3 <= $2) }" || { verdict=MISSED missed=1; }
  printf '| %-26s | %8.3f | %7.4f | %5.3f | %-6s |\n' "$1" "$4" "$3" "$2" "$verdict"
}
replayed() { # NAME LOG REFERENCE LIMIT ARGS...
  local name=$1 log=$2 reference=$3 limit=$4 json
  shift 4
  json=$("$picolo" replay "$log" --reference "$reference" --json --out "$work/out" "$@" 2>/dev/null)
  row "$name" "$limit" "$(number ape "$json")" "$(number ape_odometry "$json")"
}
radish() { # NAME LIMIT ARGS...
  local name=$1 limit=$2
  shift 2
  replayed "$name${1:+, lidar only}" "$data/radish/$name.clf.gz" "$data/radish/${name}_ref.tum.gz" "$limit" "$@" "${more[@]}"
}
more=("$@")

echo '| log                        | odometry | picolo  | limit |        |'
echo '|---|---|---|---|---|'
radish intel 0.08
radish csail 0.09
radish freiburg-079 0.072
radish freiburg-101 0.045
radish freiburg-079 0.08 --no-odometry
for source in gm:0.13 rt:0.15; do
  reference=$work/${source%:*}.tum
  awk -v s="${source%:*}" '$6 == s { printf "%s %s %s 0 0 0 %.9f %.9f\n", $2, $3, $4, sin($5 / 2), cos($5 / 2) }' \
    "$data/raw2d/intel_raw_ref.txt" >"$reference"
  replayed "intel_raw, ${source%:*} rows" "$data/raw2d/intel_raw.clf.gz" "$reference" "${source#*:}" "${more[@]}"
done
exit "$missed"
