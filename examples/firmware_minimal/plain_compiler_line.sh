#!/bin/sh
# SPDX-FileCopyrightText: picolo contributors
# SPDX-License-Identifier: Apache-2.0
# No build system at all: every source of picolo and yours in one compiler line, as an IDE or a Makefile of your own has it.
#   plain_compiler_line.sh PICOLO_SOURCE OUTPUT COMPILER FLAGS...
# For example, for a Cortex-M7 (your start-up code and linker script come with your flags):
#   plain_compiler_line.sh ~/picolo firmware.elf arm-none-eabi-g++ -mthumb -mcpu=cortex-m7 -mfloat-abi=hard -mfpu=fpv5-d16 -O2 ...
set -eu
picolo=$1
output=$2
shift 2
here=$(dirname "$0")
includes=$(find "$picolo/firmware_lib" "$picolo/hal/include" "$picolo/drivers" "$picolo/controller" -type d \
  \( -name include -o -name kernel \) -prune | sed 's/^/-I/')
sources=$(find "$picolo/firmware_lib" "$picolo/drivers" "$picolo/controller" -name '*.cpp')
eigen=${EIGEN:-/usr/include/eigen3}
# shellcheck disable=SC2086 # lists of words
exec "$@" -std=c++20 -ffp-contract=off -fno-math-errno -fno-exceptions -fno-rtti -fno-threadsafe-statics \
  -ffunction-sections -fdata-sections -Wl,--gc-sections -DEIGEN_DONT_VECTORIZE -DEIGEN_NO_IO -DEIGEN_NO_MALLOC \
  '-Deigen_assert(x)=static_cast<void>((x)||(__builtin_trap(),0))' \
  $includes -isystem "$eigen" $sources "$here/main.cpp" -o "$output"
