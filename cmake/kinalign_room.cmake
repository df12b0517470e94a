# SPDX-License-Identifier: Apache-2.0
# A room of the house (docs/architecture.md) in one call, in the CMakeLists.txt of its folder:
#
#   kinalign_room(formats/bvh          its path below kinalign/; of a program's part its path: apps/cli
#     SOURCES
#       rows.cpp
#       write.cpp
#     BRIEF                            its speed does not count: KINALIGN_JOIN optimises it less
#     USES formats take                rooms whose headers it may include, with all below them;
#                                      tools/check_includes.py holds it to that
#     LIBRARIES Eigen3::Eigen          public; PRIVATE_LIBRARIES: only its .cpp files need them
#     TESTS reader_test.cpp            in tests/<path>/, one program of cases for the room
#     APART write.cpp                  files of both lists that are never joined (KINALIGN_JOIN), since their
#                                      unnamed namespaces share names with another file of the room
#     TEST_USES simulate               further rooms that only its tests include
#     TEST_LIBRARIES fmt::fmt)
#
# A room inside another one uses its parent without saying so.

function(kinalign_flags target)
  # No contraction into fused multiply-add and no errno: a take has the same bytes on every processor.
  # -Wrestrict: g++ 12 warns falsely on "text" + std::string (GCC bug 105651).
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> -Wall -Wextra -Wpedantic
    -Wconversion -Wshadow -ffp-contract=off -fno-math-errno -fno-trapping-math)
  if(KINALIGN_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# With KINALIGN_JOIN a target's files are compiled sixteen at a time, and with -O1 if `brief`. Both together halve the CPU
# time of a build from nothing.
function(kinalign_join target brief)
  if(KINALIGN_JOIN)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)
    # g++ takes each joined file for a header, in which the use of an unnamed namespace would be a mistake.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage> $<$<BOOL:${brief}>:-O1>)
  endif()
endfunction()

# "formats/bvh" is the target kinalign_formats_bvh.
function(kinalign_targets out)
  list(TRANSFORM ARGN REPLACE "/" "_")
  list(TRANSFORM ARGN PREPEND kinalign_)
  set(${out} ${ARGN} PARENT_SCOPE)
endfunction()

function(kinalign_room path)
  cmake_parse_arguments(ROOM "BRIEF" "" "SOURCES;APART;USES;LIBRARIES;PRIVATE_LIBRARIES;TESTS;TEST_USES;TEST_LIBRARIES" ${ARGN})
  cmake_path(GET path PARENT_PATH parent)
  if(parent AND EXISTS ${CMAKE_SOURCE_DIR}/kinalign/${parent}/CMakeLists.txt)
    list(APPEND ROOM_USES ${parent})
  endif()
  kinalign_targets(target ${path})
  set(apart ${ROOM_APART})
  list(TRANSFORM apart PREPEND ${CMAKE_SOURCE_DIR}/tests/${path}/)
  set_source_files_properties(${ROOM_APART} ${apart} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  kinalign_targets(used ${ROOM_USES})
  if(ROOM_SOURCES)
    add_library(${target} STATIC ${ROOM_SOURCES})
    set(reach PUBLIC)
    target_link_libraries(${target} PRIVATE ${ROOM_PRIVATE_LIBRARIES})
    kinalign_flags(${target})
    kinalign_join(${target} ${ROOM_BRIEF})
  else()
    add_library(${target} INTERFACE)
    set(reach INTERFACE)
  endif()
  target_include_directories(${target} ${reach} ${CMAKE_SOURCE_DIR})
  target_link_libraries(${target} ${reach} ${ROOM_LIBRARIES} ${used})
  if(KINALIGN_TESTS AND ROOM_TESTS)
    kinalign_targets(tested ${ROOM_TEST_USES})
    kinalign_tests(${path} SOURCES ${ROOM_TESTS} LIBRARIES ${target} ${tested} ${ROOM_TEST_LIBRARIES})
  endif()
endfunction()

# A program of doctest cases from tests/<path>/, registered with CTest: formats_bvh_tests, and the test formats_bvh.
function(kinalign_tests path)
  cmake_parse_arguments(TESTS "" "" "SOURCES;LIBRARIES" ${ARGN})
  list(TRANSFORM TESTS_SOURCES PREPEND ${CMAKE_SOURCE_DIR}/tests/${path}/)
  string(REPLACE "/" "_" name ${path})
  if(NOT TARGET kinalign_tests_main)
    add_library(kinalign_tests_main OBJECT ${CMAKE_SOURCE_DIR}/tests/main.cpp)
    target_link_libraries(kinalign_tests_main PUBLIC doctest::doctest)
    kinalign_flags(kinalign_tests_main)
  endif()
  add_executable(${name}_tests ${TESTS_SOURCES})
  target_include_directories(${name}_tests PRIVATE ${CMAKE_SOURCE_DIR})
  target_link_libraries(${name}_tests PRIVATE kinalign_tests_main ${TESTS_LIBRARIES} Threads::Threads)
  target_compile_definitions(${name}_tests PRIVATE
    KINALIGN_SOURCE_DIR="${CMAKE_SOURCE_DIR}" KINALIGN_BINARY_DIR="${CMAKE_BINARY_DIR}")
  kinalign_flags(${name}_tests)
  kinalign_join(${name}_tests TRUE)
  add_test(NAME ${name} COMMAND ${name}_tests)
endfunction()
