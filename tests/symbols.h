// SPDX-License-Identifier: Apache-2.0
// The outside functions that a library calls, for libraries that are built freestanding.
#pragma once

#include "tests/folder.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <set>
#include <sstream>
#include <string>

namespace kinalign {

/// The names that `nm` prints of a library with `options`.
inline std::set<std::string> symbols(const std::string& library, const std::string& options) {
  const FreshFolder folder;
  const std::string command = "nm -j " + options + " '" + library + "' >'" + folder / "out" + "'";
  REQUIRE(std::system(command.c_str()) == 0);
  std::istringstream lines(folder.read("out"));
  std::set<std::string> names;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line.back() != ':') names.insert(line);
  }
  return names;
}

/// The functions that a library calls and does not define, without the four functions that any
/// compiler asks for (GCC's manual, section 2.1: the functions that a freestanding environment must
/// provide).
inline std::set<std::string> called_from_outside(const std::string& library) {
  auto called = symbols(library, "-u");
  const auto defined = symbols(library, "--defined-only");
  CHECK(!defined.empty());
  for (const auto& own : defined) called.erase(own);
  for (const auto* given : {"memcpy", "memmove", "memset", "memcmp"}) called.erase(given);
  called.erase("_GLOBAL_OFFSET_TABLE_");
  return called;
}

#ifdef KINALIGN_SANITIZED
inline constexpr bool sanitized = true;  // the library then also has the sanitizer's calls
#else
inline constexpr bool sanitized = false;
#endif

}  // namespace kinalign
