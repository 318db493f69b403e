# SPDX-FileCopyrightText: picolo contributors
# SPDX-License-Identifier: Apache-2.0
# What a customer's firmware links: libpicolo, libpicolo_drivers, libpicolo_controller, their public headers, and the files by which
# CMake (find_package) and pkg-config find them. Ports and apps are not installed: a product has its own.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(picolo_apis)
foreach(module IN ITEMS core geometry sensing map solve undistort matching odometry localisation calibration evaluation executive)
  list(APPEND picolo_apis picolo_${module}_api)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/firmware_lib/${module}/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endforeach()
file(GLOB picolo_driver_includes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/drivers/*/include)
foreach(folder IN LISTS picolo_driver_includes ITEMS ${PROJECT_SOURCE_DIR}/hal/include ${PROJECT_SOURCE_DIR}/controller/include)
  install(DIRECTORY ${folder}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endforeach()

set(picolo_libraries picolo picolo_drivers picolo_controller)
foreach(target IN LISTS picolo_libraries picolo_apis ITEMS picolo_hal picolo_numbers)
  string(REGEX REPLACE "^picolo_" "" name ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(${target} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
endforeach()
install(TARGETS ${picolo_libraries} ${picolo_apis} picolo_hal picolo_numbers EXPORT picolo
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})

set(picolo_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/picolo)
install(EXPORT picolo NAMESPACE picolo:: FILE picoloTargets.cmake DESTINATION ${picolo_cmake_dir})
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/picoloConfig.cmake
  CONTENT "include(\${CMAKE_CURRENT_LIST_DIR}/picoloTargets.cmake)\n" @ONLY)
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/picoloConfigVersion.cmake
  VERSION ${PROJECT_VERSION} COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/picoloConfig.cmake ${PROJECT_BINARY_DIR}/picoloConfigVersion.cmake
  DESTINATION ${picolo_cmake_dir})

# Relative to itself, so that an installed tree may be moved.
set(picolo_pc_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH picolo_pc_to_prefix /${picolo_pc_dir} /)
string(REGEX REPLACE "/$" "" picolo_pc_to_prefix ${picolo_pc_to_prefix})
configure_file(${PROJECT_SOURCE_DIR}/cmake/picolo.pc.in ${PROJECT_BINARY_DIR}/picolo.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/picolo.pc DESTINATION ${picolo_pc_dir})
