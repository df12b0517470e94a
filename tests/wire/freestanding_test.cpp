// SPDX-License-Identifier: Apache-2.0
// The room is compiled freestanding, without exceptions and RTTI; this asks what it still calls.
#include "tests/folder.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <set>
#include <sstream>

namespace {

/// The first names of `nm` on the library with `options`.
std::set<std::string> symbols(const std::string& options) {
  const kinalign::FreshFolder folder;
  const std::string command =
      "nm -j " + options + " '" KINALIGN_WIRE_LIBRARY "' >'" + folder / "out" + "'";
  REQUIRE(std::system(command.c_str()) == 0);
  std::istringstream lines(folder.read("out"));
  std::set<std::string> names;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line.back() != ':') names.insert(line);
  }
  return names;
}

#ifdef KINALIGN_SANITIZED
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

}  // namespace

TEST_CASE("wire calls nothing but itself and the four functions that any compiler asks for" *
          doctest::description("a sanitizer's calls are in it") * doctest::skip(sanitized)) {
  auto called = symbols("-u");
  const auto defined = symbols("--defined-only");
  CHECK(!defined.empty());
  for (const auto& own : defined) called.erase(own);
  // GCC's manual, section 2.1: what a freestanding environment has to give
  for (const auto* given : {"memcpy", "memmove", "memset", "memcmp"}) called.erase(given);
  called.erase("_GLOBAL_OFFSET_TABLE_");
  CHECK(called == std::set<std::string>{});
}
