# SPDX-FileCopyrightText: picolo contributors
# SPDX-License-Identifier: Apache-2.0
# Cortex-A53 without an operating system; QEMU machine xlnx-zcu102. Debian has no aarch64-none-elf: its Linux compiler
# serves, without start files and libraries.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(PICOLO_BOARD zcu102)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_NM aarch64-linux-gnu-nm CACHE STRING "")
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_POSITION_INDEPENDENT_CODE OFF)

string(JOIN " " picolo_target_flags -mcpu=cortex-a53 -mstrict-align -mno-outline-atomics -fno-pic -fno-pie
  -fno-stack-protector -fno-unwind-tables -fno-asynchronous-unwind-tables)
set(CMAKE_C_FLAGS_INIT "${picolo_target_flags}")
set(CMAKE_CXX_FLAGS_INIT "${picolo_target_flags} -fno-exceptions -fno-rtti -fno-threadsafe-statics")
set(CMAKE_EXE_LINKER_FLAGS_INIT
  "-nostdlib -static -no-pie -Wl,--gc-sections -Wl,--build-id=none -Wl,--no-warn-rwx-segments")
