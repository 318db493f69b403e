#!/usr/bin/env bash
# SPDX-FileCopyrightText: picolo contributors
# SPDX-License-Identifier: Apache-2.0
# The binary interface of picolo.h against the one that was recorded. abi.sh SOURCE WORK COMPILER [--record]
set -euo pipefail
source=$1 work=$2 compiler=$3
recorded=$source/tests/package/abi/picolo_c.abi
command -v abidiff >/dev/null || { echo "no abidiff (Debian package abigail-tools)"; exit 77; }
mkdir -p "$work"
cd "$work"
# Only the interface counts: nothing else of the library is linked.
echo '{ global: picolo_*; local: *; };' >picolo_c.map
mapfile -t includes < <(find "$source/firmware_lib" "$source/hal" "$source/controller" -type d -name include -printf '-I%p\n')
"$compiler" -std=c++20 -g -O0 -fPIC -shared "${includes[@]}" -Wl,--version-script=picolo_c.map -o libpicolo_c.so \
  "$source/controller/c_facade.cpp"
abidw --headers-dir "$source/controller/include/picolo" --drop-private-types \
  --suppressions "$source/tests/package/abi/private.abignore" --no-comp-dir-path --no-corpus-path --no-show-locs \
  --out-file now.abi libpicolo_c.so
sed -i "s# path='[^']*'##" now.abi
if [[ ${4:-} == --record ]]; then
  cp now.abi "$recorded"
  exit
fi
if ! abidiff "$recorded" now.abi; then
  echo "The binary interface of picolo.h has changed. When that is wanted, raise the version in" >&2
  echo "firmware_lib/core/include/picolo/core/version.h and record it: tests/package/abi/abi.sh SOURCE WORK c++ --record" >&2
  exit 1
fi
