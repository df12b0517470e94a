// SPDX-License-Identifier: Apache-2.0
// What the fuzz targets are seeded with and once stumbled over (tests/data/fuzz), played again by
// an ordinary build: a target that finds a fault aborts. Each target is compiled in under its own
// name.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

using Target = int(const std::uint8_t* data, std::size_t size);
extern "C" {
Target fuzz_bvh, fuzz_layout, fuzz_manifest, fuzz_ntu_skeleton, fuzz_opensim_sto,
    fuzz_parameters_json, fuzz_table, fuzz_take_hdf5, fuzz_trc, fuzz_ui_prmd_kinect,
    fuzz_xsens_text;
}

namespace {

void replay(const std::string& name, Target* target) {
  const std::filesystem::path folder = KINALIGN_SOURCE_DIR "/tests/data/fuzz/" + name + "_fuzz";
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    // whole, and cut at a hundred places
    for (std::size_t k = 0; k <= 100; ++k) CHECK(target(data, bytes.size() * k / 100) == 0);
    ++files;
  }
  CHECK(files > 0);
}

}  // namespace

TEST_CASE("BVH: no fuzz input fails again") { replay("bvh", fuzz_bvh); }
TEST_CASE("layouts: no fuzz input fails again") { replay("layout", fuzz_layout); }
TEST_CASE("manifests: no fuzz input fails again") { replay("manifest", fuzz_manifest); }
TEST_CASE("NTU: no fuzz input fails again") { replay("ntu_skeleton", fuzz_ntu_skeleton); }
TEST_CASE("OpenSim: no fuzz input fails again") { replay("opensim_sto", fuzz_opensim_sto); }
TEST_CASE("parameters: no fuzz input fails again") {
  replay("parameters_json", fuzz_parameters_json);
}
TEST_CASE("tables: no fuzz input fails again") { replay("table", fuzz_table); }
TEST_CASE("takes: no fuzz input fails again") { replay("take_hdf5", fuzz_take_hdf5); }
TEST_CASE("TRC: no fuzz input fails again") { replay("trc", fuzz_trc); }
TEST_CASE("UI-PRMD: no fuzz input fails again") { replay("ui_prmd_kinect", fuzz_ui_prmd_kinect); }
TEST_CASE("Xsens: no fuzz input fails again") { replay("xsens_text", fuzz_xsens_text); }
