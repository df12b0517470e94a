// SPDX-License-Identifier: Apache-2.0
// Every BVH of ../shared/data, compared with positions that NumPy computed, stored there or
// computed here.
#include "tests/shared_data.h"
#include "tests/witness.h"

#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/motion/kinematics.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

using namespace kinalign;

namespace {

struct Place {
  std::size_t frame, joint;
  std::string name;
  double x, y, z;
};

/// fk_reference.csv: file, frame, joint_index, joint, x, y, z in the file's own units.
std::map<std::string, std::vector<Place>> reference(const std::string& path) {
  std::map<std::string, std::vector<Place>> places;
  std::istringstream lines(bytes_in(path));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::string file, frame, joint, name, x, y, z;
    for (auto* cell : {&file, &frame, &joint, &name, &x, &y, &z}) std::getline(cells, *cell, ',');
    places[file].push_back(
        {std::stoul(frame), std::stoul(joint), name, std::stod(x), std::stod(y), std::stod(z)});
  }
  return places;
}

/// Compares the files, and gives their number.
std::size_t compare(const std::string& folder, const std::string& reference_file) {
  std::size_t files = 0;
  for (const auto& [name, places] : reference(reference_file)) {
    CAPTURE(name);
    BvhOptions own_units;
    own_units.metres_per_unit = 1.0;
    const auto file = read_bvh(bytes_in(folder + name), name, own_units);
    REQUIRE(file);
    const std::size_t joints = file->clip.skeleton.joints();
    std::vector<double> global(file->clip.frames.size() * joints * 3);
    forward_kinematics(file->clip.skeleton, file->clip.frames, global);
    double worst = 0.0;
    for (const Place& place : places) {
      REQUIRE(place.frame < file->clip.frames.size());
      CHECK(file->clip.skeleton.joint_names[place.joint] == place.name);
      const Vec3 at = vec3(std::span<const double>(global), place.frame * joints + place.joint);
      worst = std::max(worst, (at - Vec3(place.x, place.y, place.z)).norm());
    }
    // The reference has 6 decimals of the file's unit; the limit is 1e-5 m, 1e-3 of a centimetre.
    CHECK(worst < 2e-6);
    CHECK(places.size() >= joints);
    ++files;
  }
  return files;
}

/// The files with frames below ../shared/data.
std::vector<std::string> files_with_frames() {
  std::vector<std::string> paths;
  for (const auto& path : shared_bvh_files()) {
    const auto file = read_bvh(bytes_in(path), "any", {});
    REQUIRE(file);
    if (file->clip.frames.size() > 0) paths.push_back(path.string());
  }
  return paths;
}

}  // namespace

TEST_CASE("positions of real BVH files equal an independent kinematics" *
          doctest::skip(!shared_data())) {
  const std::string folder = shared_path("bvh/");
  CHECK(compare(folder, folder + "fk_reference.csv") == 17);
}

TEST_CASE("positions of a Perception Neuron file with moving joints do too" *
          doctest::skip(!shared_data())) {
  const std::string folder = shared_path("no_terms_stated/pn_bvh/");
  CHECK(compare(folder, folder + "fk_reference.csv") == 1);
}

TEST_CASE("positions of every real BVH with frames equal another kinematics in NumPy" *
          doctest::skip(!shared_data())) {
  const std::vector<std::string> paths = files_with_frames();
  CHECK(paths.size() >= 19);
  const FreshFolder folder;
  std::string list;
  for (const std::string& path : paths) list += path + "\n";
  folder.write("files.txt", list);
  REQUIRE(run_witness("bvh_positions.py", folder.path()) == 0);
  CHECK(compare("", folder / "positions.csv") == paths.size());
}

TEST_CASE("every real BVH reads, writes and reads again to the same numbers" *
          doctest::skip(!shared_data())) {
  std::size_t files = 0;
  for (const auto& path : shared_bvh_files()) {
    CAPTURE(path.filename().string());
    const auto first = read_bvh(bytes_in(path), "first", {});
    REQUIRE(first);
    std::string text;
    const auto sink = [&text](std::string_view piece) -> Result<void> {
      text += piece;
      return {};
    };
    REQUIRE(write_bvh(*first, sink));
    const auto second = read_bvh(text, "second", {});
    REQUIRE(second);
    CHECK(second->values == first->values);
    CHECK(second->hierarchy.names == first->hierarchy.names);
    CHECK(second->hierarchy.offsets == first->hierarchy.offsets);
    CHECK(second->hierarchy.channels == first->hierarchy.channels);
    CHECK(second->hierarchy.end_sites.size() == first->hierarchy.end_sites.size());
    CHECK(second->hierarchy.frame_seconds == first->hierarchy.frame_seconds);
    ++files;
  }
  CHECK(files >= 20);
}
