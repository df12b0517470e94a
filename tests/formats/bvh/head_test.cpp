// SPDX-License-Identifier: Apache-2.0
// A rig's header as a recording keeps it.
#include "kinalign/formats/bvh/head.h"

#include "tests/folder.h"
#include "tests/shared_data.h"

#include <doctest/doctest.h>

#include <filesystem>

using namespace kinalign;

namespace {

const std::string hierarchy =
    "HIERARCHY\nROOT motion capture\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
    "End Site\n{\nOFFSET 0 1 0\n}\n}\n";

std::string head_of(const std::string& text) {
  const FreshFolder folder;
  PosixFiles files;
  const auto head = read_bvh_head(files, folder.write("rig.bvh", text));
  return head ? *head : to_string(head.error());
}

}  // namespace

TEST_CASE("a head stands alone as a BVH of no rows, with the hierarchy as it was written") {
  const std::string alone = hierarchy + "MOTION\nFrames: 0\nFrame Time: .008333\n";
  CHECK(head_of(hierarchy + "MOTION\nFrames: 2\nFrame Time: .008333\n1 2 3\n4 5 6\n") == alone);
  CHECK(head_of(hierarchy + "motion Frames: 2 Frame Time: .008333 1 2 3 4 5 6") == alone);
  CHECK(head_of(alone) == alone);
}

TEST_CASE("what has no head of a BVH is refused") {
  CHECK(head_of("").find("rig.bvh:1: expected HIERARCHY") != std::string::npos);
  CHECK(head_of(hierarchy).find("expected") != std::string::npos);
  CHECK(head_of(hierarchy + "MOTION\nFrames: 2\n").find("expected") != std::string::npos);
}

TEST_CASE("the head of every real BVH reads to the same hierarchy" *
          doctest::skip(!shared_data())) {
  PosixFiles files;
  std::size_t count = 0;
  for (const auto& path : shared_bvh_files()) {
    CAPTURE(path.string());
    const auto head = read_bvh_head(files, path.string());
    const auto whole = read_bvh(bytes_in(path), "whole", {});
    CHECK(head.has_value() == whole.has_value());
    if (!head || !whole) continue;
    const auto alone = read_bvh(*head, "alone", {});
    REQUIRE(alone);
    CHECK(alone->hierarchy.names == whole->hierarchy.names);
    CHECK(alone->hierarchy.parents == whole->hierarchy.parents);
    CHECK(alone->hierarchy.offsets == whole->hierarchy.offsets);
    CHECK(alone->hierarchy.channels == whole->hierarchy.channels);
    CHECK(alone->hierarchy.frame_time == whole->hierarchy.frame_time);
    CHECK(alone->values.empty());
    ++count;
  }
  CHECK(count > 5);
}
