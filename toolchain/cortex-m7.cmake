# SPDX-FileCopyrightText: picolo contributors
# SPDX-License-Identifier: Apache-2.0
# Cortex-M7 with double precision in hardware; QEMU machine mps2-an500.
set(PICOLO_CPU_FLAGS "-mcpu=cortex-m7 -mfloat-abi=hard -mfpu=fpv5-d16")
set(PICOLO_BOARD mps2_an500)
include(${CMAKE_CURRENT_LIST_DIR}/arm-none-eabi.cmake)
