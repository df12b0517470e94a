// SPDX-License-Identifier: Apache-2.0
// Runs the fuzz targets on their seeds and on inputs that once failed (tests/data/fuzz), in an
// ordinary build: a target that finds a fault aborts. Each target is compiled in under its own
// name.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

using Target = int(const std::uint8_t* data, std::size_t size);
#define TARGET(name) extern "C" Target fuzz_##name;
KINALIGN_FUZZ_TARGETS
#undef TARGET

namespace {

void replay(const std::string& name, Target* target) {
  const std::filesystem::path folder = KINALIGN_SOURCE_DIR "/tests/data/fuzz/" + name + "_fuzz";
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    // The input is given whole, and cut at a hundred places.
    for (std::size_t k = 0; k <= 100; ++k) CHECK(target(data, bytes.size() * k / 100) == 0);
    ++files;
  }
  CHECK(files > 0);
}

}  // namespace

#define TARGET(name) \
  TEST_CASE(#name ": no fuzz input fails again") { replay(#name, fuzz_##name); }
KINALIGN_FUZZ_TARGETS
