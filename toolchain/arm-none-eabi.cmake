# SPDX-FileCopyrightText: picolo contributors
# SPDX-License-Identifier: Apache-2.0
# What the Cortex-M toolchain files share. They set PICOLO_CPU_FLAGS and include this file.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_NM arm-none-eabi-nm CACHE STRING "")
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)

string(JOIN " " picolo_target_flags -mthumb ${PICOLO_CPU_FLAGS} -fno-unwind-tables
  -fno-asynchronous-unwind-tables -Wno-psabi)
set(CMAKE_C_FLAGS_INIT "${picolo_target_flags}")
set(CMAKE_CXX_FLAGS_INIT "${picolo_target_flags} -fno-exceptions -fno-rtti -fno-threadsafe-statics -fno-use-cxa-atexit")
# newlib-nano without system calls: no _sbrk, so whoever calls malloc does not link.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-nostartfiles --specs=nano.specs -Wl,--gc-sections -Wl,--fatal-warnings -Wl,--no-warn-rwx-segments")
