# SPDX-FileCopyrightText: picolo contributors
# SPDX-License-Identifier: Apache-2.0
# Interface targets carry every compiler switch of the project:
#   picolo_numbers   what makes the bits equal on every platform; public, travels with libpicolo.a
#   picolo_unfused   what they need beyond that inside the library; private
#   picolo_warnings  what keeps our own code clean; private

set(PICOLO_SANITIZE "" CACHE STRING "Sanitizers to build with, e.g. address,undefined")
if(PICOLO_SANITIZE)
  add_compile_options(-fsanitize=${PICOLO_SANITIZE} -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${PICOLO_SANITIZE})
  # gcc sees uninitialised members in libstdc++'s own regular expressions when they are instrumented.
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-Wno-error=maybe-uninitialized>)
  # The library has no RTTI, which the check of virtual calls wants of its classes.
  if(PICOLO_SANITIZE MATCHES undefined)
    add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-fno-sanitize=vptr>)
  endif()
endif()

add_library(picolo_numbers INTERFACE)
target_compile_features(picolo_numbers INTERFACE cxx_std_20)
target_compile_options(picolo_numbers INTERFACE -ffp-contract=off -fno-math-errno)
target_compile_definitions(picolo_numbers INTERFACE EIGEN_DONT_VECTORIZE EIGEN_NO_IO EIGEN_NO_MALLOC)

# gcc's vectoriser forms vfmaddsub in spite of -ffp-contract=off. Does not travel: a customer's Eigen may want FMA.
add_library(picolo_unfused INTERFACE)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|i.86")
  target_compile_options(picolo_unfused INTERFACE -mno-fma)
endif()

# The same bits as without, several times as fast on x86-64 of 2013 and later. Never with FMA: it rounds once where others round twice.
option(PICOLO_AVX2 "Build the matching kernels with AVX2 instructions" OFF)

add_library(picolo_warnings INTERFACE)
target_compile_options(picolo_warnings INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow
  -Wold-style-cast -Wnon-virtual-dtor -Wundef -Wcast-align -Wswitch-enum>
  # clang's -Wdouble-promotion covers initialisation too, a nuisance in tests: there it is for the target's code only.
  $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wdouble-promotion>
  # GCC 12 takes `literal + std::string` at -O3 for overlapping copies (its bug 105651).
  $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-restrict>
  $<$<BOOL:${PICOLO_WERROR}>:-Werror>)

# What runs on the target: no exceptions, no RTTI, no guards around statics.
add_library(picolo_firmware INTERFACE)
target_compile_options(picolo_firmware INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-fno-exceptions -fno-rtti -fno-threadsafe-statics -Wdouble-promotion>
  -ffunction-sections -fdata-sections
  # Eigen's own assert brings in printf and abort.
  "-Deigen_assert(x)=static_cast<void>((x)||(__builtin_trap(),0))")

# The library's Eigen has a name of its own. A customer's Eigen, vectorised and fused, has the same templates; the linker
# keeps one of each name, and with the customer's the bits would change (apps/firmware/determinism/hostile.cpp).
target_compile_definitions(picolo_firmware INTERFACE Eigen=EigenOfPicolo)

set(CMAKE_CXX_EXTENSIONS OFF)

# picolo_module(NAME [DEPENDS other...]): one folder of firmware_lib. picolo_NAME_api carries the folder's headers and those it
# may see, so that an include which points upward in the design does not even resolve; picolo_NAME compiles all its *.cpp.
function(picolo_module name)
  cmake_parse_arguments(ARG "" "" "DEPENDS" ${ARGN})
  list(TRANSFORM ARG_DEPENDS PREPEND picolo_)
  list(TRANSFORM ARG_DEPENDS APPEND _api)
  add_library(picolo_${name}_api INTERFACE)
  target_include_directories(picolo_${name}_api INTERFACE
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/${name}/include>)
  if(IS_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/${name}/kernel)
    # Inline kernels shared between folders of the library; never seen by a customer's compiler.
    target_include_directories(picolo_${name}_api INTERFACE
      $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/${name}/kernel>)
  endif()
  target_link_libraries(picolo_${name}_api INTERFACE picolo_numbers ${ARG_DEPENDS})

  target_include_directories(picolo PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/${name}/include>)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  if(NOT sources)
    return()
  endif()
  add_library(picolo_${name} OBJECT ${sources})
  target_include_directories(picolo_${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/${name})
  target_link_libraries(picolo_${name} PRIVATE picolo_${name}_api picolo_unfused picolo_warnings picolo_firmware)
  if(PICOLO_AVX2 AND name STREQUAL "matching")
    target_compile_options(picolo_${name} PRIVATE -mavx2 -mno-fma)
    target_compile_definitions(picolo_${name} PRIVATE PICOLO_AVX2)
  endif()
  if(NOT name STREQUAL "core")
    target_link_libraries(picolo_${name} PRIVATE Eigen3::Eigen)
  endif()
  target_sources(picolo PRIVATE $<TARGET_OBJECTS:picolo_${name}>)
endfunction()

# picolo_package(NAME SOURCES files... DEPENDS targets...): a static library next to libpicolo.a (drivers, controller, a port).
# Its public headers live in include/ beside its CMakeLists.txt.
function(picolo_package name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_library(picolo_${name} STATIC ${ARG_SOURCES})
  add_library(picolo::${name} ALIAS picolo_${name})
  target_include_directories(picolo_${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>)
  target_link_libraries(picolo_${name} PUBLIC picolo_numbers ${ARG_DEPENDS}
    PRIVATE $<BUILD_INTERFACE:picolo_unfused> $<BUILD_INTERFACE:picolo_warnings>)
endfunction()
