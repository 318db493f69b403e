#!/usr/bin/env bash
# SPDX-FileCopyrightText: picolo contributors
# SPDX-License-Identifier: Apache-2.0
# Builds examples/firmware_minimal as a customer would, and runs it. consume.sh WAY SOURCE BUILD WORK COMPILER [LAUNCHER]
set -euo pipefail
way=$1 source=$2 build=$3 work=$4 compiler=$5 launcher=${6:-}
example=$work/$way/firmware_minimal
prefix=$work/prefix
rm -rf "${work:?}/$way"
mkdir -p "$work/$way"
cp -r "$source/examples/firmware_minimal" "$example" # a customer's copy knows nothing of this tree
export CXX=$compiler

with_cmake() {
  cmake -S "$example" -B "$work/$way/build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 \
    ${launcher:+-DCMAKE_CXX_COMPILER_LAUNCHER=$launcher} -DPICOLO_FROM="$1" "${@:2}" >"$work/$way/configure.log" ||
    { cat "$work/$way/configure.log"; exit 1; }
  cmake --build "$work/$way/build" --target firmware_minimal
  "$work/$way/build/firmware_minimal"
}

case $way in
  install)
    rm -rf "$prefix"
    cmake --install "$build" --prefix "$work/first" >/dev/null
    mv "$work/first" "$prefix" # an installed tree may be moved
    ;;
  subdirectory) with_cmake subdirectory -DPICOLO_SOURCE="$source" ;;
  fetch) with_cmake fetch -DFETCHCONTENT_SOURCE_DIR_PICOLO="$source" ;;
  package)
    with_cmake package -DCMAKE_PREFIX_PATH="$prefix"
    # Another minor version is another interface, as long as the major one is 0.
    sed -i 's/find_package(picolo 0.1 /find_package(picolo 0.0 /' "$example/CMakeLists.txt"
    if cmake -S "$example" -B "$work/$way/other" -DCMAKE_PREFIX_PATH="$prefix" >"$work/$way/other.log" 2>&1; then
      echo "a package of another minor version was accepted" >&2
      exit 1
    fi
    grep -q 'version: 0.1' "$work/$way/other.log" || { cat "$work/$way/other.log"; exit 1; }
    ;;
  pkgconfig)
    PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name picolo.pc)")
    export PKG_CONFIG_PATH
    make -C "$example"
    "$example/firmware_minimal"
    # and a program in C
    # shellcheck disable=SC2046 # lists of words
    cc -std=c11 $(pkg-config --cflags picolo) "$source/tests/package/c_facade/c_drive.c" -o "$work/$way/c_drive" \
      $(pkg-config --libs picolo) -lm
    "$work/$way/c_drive"
    ;;
  arm)
    command -v arm-none-eabi-g++ >/dev/null || { echo "no arm-none-eabi-g++"; exit 77; }
    elf=$work/$way/firmware.elf
    # No start-up code here: it is linked, not run. Without _sbrk whoever calls malloc does not link.
    "$example/plain_compiler_line.sh" "$source" "$elf" arm-none-eabi-g++ -mthumb -mcpu=cortex-m7 -mfloat-abi=hard \
      -mfpu=fpv5-d16 -O1 -fno-use-cxa-atexit -fno-unwind-tables -fno-asynchronous-unwind-tables -Wno-psabi \
      -nostartfiles --specs=nano.specs -Wl,--entry=main
    arm-none-eabi-size "$elf"
    if arm-none-eabi-nm "$elf" | grep -E ' (malloc|free|_sbrk|_Zn[wa]|_Zd[la]|__cxa_throw|printf|abort)'; then
      echo "the image holds what firmware must not hold" >&2
      exit 1
    fi
    ;;
esac
