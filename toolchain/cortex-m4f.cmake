# SPDX-FileCopyrightText: picolo contributors
# SPDX-License-Identifier: Apache-2.0
# Cortex-M4F, single precision in hardware and double in software; QEMU machine mps2-an386.
set(PICOLO_CPU_FLAGS "-mcpu=cortex-m4 -mfloat-abi=hard -mfpu=fpv4-sp-d16")
set(PICOLO_BOARD mps2_an386)
include(${CMAKE_CURRENT_LIST_DIR}/arm-none-eabi.cmake)
