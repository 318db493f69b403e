/* SPDX-FileCopyrightText: picolo contributors
 * SPDX-License-Identifier: Apache-2.0 */
/** @file
 * The version of the library, in this one place: CMake, the package files and C++ read it here. */
#ifndef PICOLO_CORE_VERSION_H
#define PICOLO_CORE_VERSION_H

#define PICOLO_VERSION_MAJOR 0
#define PICOLO_VERSION_MINOR 1
#define PICOLO_VERSION_PATCH 0

#endif
