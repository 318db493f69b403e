# SPDX-FileCopyrightText: picolo contributors
# SPDX-License-Identifier: Apache-2.0
# PICOLO_VERSION from firmware_lib/core/include/picolo/core/version.h, the one place where it stands.
set(picolo_version_file ${CMAKE_CURRENT_LIST_DIR}/../firmware_lib/core/include/picolo/core/version.h)
file(STRINGS ${picolo_version_file} picolo_version_lines REGEX "^#define PICOLO_VERSION_")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${picolo_version_file})
set(picolo_version_parts)
foreach(part IN ITEMS MAJOR MINOR PATCH)
  if(NOT picolo_version_lines MATCHES "PICOLO_VERSION_${part} ([0-9]+)")
    message(FATAL_ERROR "${picolo_version_file} does not define PICOLO_VERSION_${part}")
  endif()
  list(APPEND picolo_version_parts ${CMAKE_MATCH_1})
endforeach()
list(JOIN picolo_version_parts . PICOLO_VERSION)
