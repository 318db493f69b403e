# SPDX-FileCopyrightText: picolo contributors
# SPDX-License-Identifier: Apache-2.0
# picolo_test(NAME LABELS label... [DEPENDS targets...] [DEFINITIONS ...] [PROPERTIES ctest...] [TIMEOUT s]): all *.cpp of the calling folder form one
# Google Test binary; every TEST in it is one ctest entry named NAME.Suite.Case and carries the labels. The first label is
# the group: unit, property, drivers, ports, integration ...; `slow` beside it (as in integration-slow) keeps a test out of
# the short run.
# PICOLO_TEST_DATA is where recordings are looked for; tests that need one say PICOLO_NEED_DATA (tests/support).
include(GoogleTest)

# Google Test and the standard headers that most tests name, parsed once: a minute less to wait for. The other presets
# compile every test by its own includes alone.
option(PICOLO_TEST_PCH "Precompile the headers that most tests include" OFF)

set(PICOLO_TEST_DATA "${PROJECT_SOURCE_DIR}/../shared/data" CACHE PATH "Folder with the recorded data sets")

function(picolo_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "LABELS;DEPENDS;DEFINITIONS;PROPERTIES" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  # Every test's name starts with its group, the first label: the report of `./run test` counts by it.
  list(GET ARG_LABELS 0 group)
  if(NOT name MATCHES "^${group}(_|$)")
    set(name ${group}_${name})
  endif()
  # gtest_discover_tests takes a list apart and keeps its first element: one word carries all labels.
  list(JOIN ARG_LABELS - label)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  add_executable(test_${name} ${sources})
  target_link_libraries(test_${name} PRIVATE picolo_test_support ${ARG_DEPENDS} picolo::picolo
    GTest::gmock GTest::gtest_main picolo_warnings)
  target_compile_definitions(test_${name} PRIVATE ${ARG_DEFINITIONS})
  # The library under test keeps its optimisation; tests themselves build a third faster with less.
  target_compile_options(test_${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  if(PICOLO_TEST_PCH)
    target_precompile_headers(test_${name} REUSE_FROM picolo_test_headers)
    target_compile_options(test_${name} PRIVATE -fpch-preprocess) # for ccache, which run tells to accept it
  endif()
  gtest_discover_tests(test_${name} TEST_PREFIX ${name}. DISCOVERY_MODE PRE_TEST
    PROPERTIES LABELS ${label} TIMEOUT ${ARG_TIMEOUT} ${ARG_PROPERTIES})
endfunction()
