// SPDX-License-Identifier: Apache-2.0
// The known corpora, recognised by their files.
#include "kinalign/dataset/import/corpora.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

/// The kind of corpus that has files of these names, or the error.
std::string kind_of(const std::vector<std::string>& names, const std::string& from = "") {
  std::vector<SourceFile> sources;
  for (const std::string& name : names) sources.push_back({"/nowhere/" + name, name});
  PosixFiles files;
  const auto kind = find_corpus(files, sources, from, "SOURCE");
  return kind ? std::string(kind->name) : to_string(kind.error());
}

}  // namespace

TEST_CASE("a corpus is known by the names of its files") {
  CHECK(kind_of({"Segmented Movements/Kinect/Positions/m01_s01_e01_positions.txt"}) == "ui-prmd");
  CHECK(kind_of({"s07.npz"}) == "ui-prmd");
  CHECK(kind_of({"asf_00.npz", "README.md"}) == "cmu");
  CHECK(kind_of({"G3-Vicon-CTK-P1T1-Unknown-C-0.txt"}) == "keraal");
  CHECK(kind_of({"nturgb+d_skeletons/S001C001P001R001A001.skeleton"}) == "ntu");
  CHECK(kind_of({"sub-01/motion/sub-01_task-walk_tracksys-imu_motion.tsv"}) == "bids");
  CHECK(kind_of({"a/b.BVH"}) == "bvh");
  CHECK(kind_of({"a.c3d", "notes.txt"}) == "c3d");
  CHECK(kind_of({"a.mvnx.gz"}) == "mvnx");
  CHECK(kind_of({"a.trc"}) == "trc");
}

TEST_CASE("pairs for learning are made only where they are asked for") {
  CHECK(kind_of({"s07.npz"}, "ui-prmd-joints") == "ui-prmd-joints");
  CHECK(kind_of({"s07.npz"}) == "ui-prmd");
}

TEST_CASE("a known corpus takes precedence over single files next to it") {
  CHECK(kind_of({"asf_00.npz", "extra/walk.bvh"}) == "cmu");
  CHECK(kind_of({"asf_00.npz", "extra/walk.bvh"}, "bvh") == "bvh");
  CHECK(kind_of({"a.bvh", "a.c3d"}).find("--from") != std::string::npos);
  CHECK(kind_of({"m01_s01_e01_angles.txt"}).find("known corpus") != std::string::npos);
}
