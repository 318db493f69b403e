# SPDX-FileCopyrightText: picolo contributors
# SPDX-License-Identifier: Apache-2.0
# Cortex-M55 with double precision in hardware; QEMU machine mps3-an547.
set(PICOLO_CPU_FLAGS "-mcpu=cortex-m55 -mfloat-abi=hard -mfpu=auto")
set(PICOLO_BOARD mps3_an547)
include(${CMAKE_CURRENT_LIST_DIR}/arm-none-eabi.cmake)
