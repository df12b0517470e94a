# SPDX-License-Identifier: Apache-2.0
# A room of the house (docs/architecture.md) in one call:
#
#   kinalign_room(motion
#     SOURCES kinematics.cpp spline.cpp
#     USES core                      rooms whose headers it may include; tools/check_includes.py holds it to that
#     LIBRARIES Eigen3::Eigen        public; PRIVATE_LIBRARIES for what only its .cpp files need
#     TESTS kinematics_test.cpp)     in tests/<room>/, one program of cases for the room

function(kinalign_flags target)
  # No contraction into fused multiply-add and no errno: a take has the same bytes on every processor.
  # -Wrestrict: g++ 12 warns falsely on "text" + std::string (GCC bug 105651).
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> -Wall -Wextra -Wpedantic
    -Wconversion -Wshadow -ffp-contract=off -fno-math-errno -fno-trapping-math)
  if(KINALIGN_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

function(kinalign_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;USES;LIBRARIES;PRIVATE_LIBRARIES;TESTS" ${ARGN})
  set(target kinalign_${name})
  if(ROOM_SOURCES)
    add_library(${target} STATIC ${ROOM_SOURCES})
    set(reach PUBLIC)
    target_link_libraries(${target} PRIVATE ${ROOM_PRIVATE_LIBRARIES})
    kinalign_flags(${target})
  else()
    add_library(${target} INTERFACE)
    set(reach INTERFACE)
  endif()
  target_include_directories(${target} ${reach} ${CMAKE_SOURCE_DIR})
  target_link_libraries(${target} ${reach} ${ROOM_LIBRARIES})
  foreach(used IN LISTS ROOM_USES)
    target_link_libraries(${target} ${reach} kinalign_${used})
  endforeach()
  if(KINALIGN_TESTS AND ROOM_TESTS)
    kinalign_tests(${name} SOURCES ${ROOM_TESTS} LIBRARIES ${target})
  endif()
endfunction()

# A program of doctest cases from tests/<name>/, registered with CTest.
function(kinalign_tests name)
  cmake_parse_arguments(TESTS "" "" "SOURCES;LIBRARIES" ${ARGN})
  list(TRANSFORM TESTS_SOURCES PREPEND ${CMAKE_SOURCE_DIR}/tests/${name}/)
  add_executable(${name}_tests ${CMAKE_SOURCE_DIR}/tests/main.cpp ${TESTS_SOURCES})
  target_include_directories(${name}_tests PRIVATE ${CMAKE_SOURCE_DIR})
  target_link_libraries(${name}_tests PRIVATE ${TESTS_LIBRARIES} doctest::doctest Threads::Threads)
  target_compile_definitions(${name}_tests PRIVATE
    KINALIGN_SOURCE_DIR="${CMAKE_SOURCE_DIR}" KINALIGN_BINARY_DIR="${CMAKE_BINARY_DIR}")
  kinalign_flags(${name}_tests)
  add_test(NAME ${name} COMMAND ${name}_tests)
endfunction()
