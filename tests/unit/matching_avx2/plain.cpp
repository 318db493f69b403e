// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#define PICOLO_KERNELS plain
#include "kernels.inc"
