// SPDX-License-Identifier: Apache-2.0
// The part of a BVH above the rows: where errors are found, and the head as a recording keeps it.
#include "kinalign/formats/bvh/head.h"

#include "tests/folder.h"
#include "tests/shared_data.h"

#include <doctest/doctest.h>

#include <array>
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

std::string fault(const std::string& text) {
  const auto file = read_bvh(text, "a.bvh", {});
  return file ? "none" : to_string(file.error());
}

const std::string begin = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n";
const std::string motion = "}\nMOTION\nFrames: 1\nFrame Time: 0.01\n7\n";

}  // namespace

TEST_CASE("a missing part of a BVH's head is reported at its place") {
  const std::vector<std::array<std::string, 2>> refused{
      {"HIERARCHY\nROOT\n{\n", "a.bvh:2: expected a name, found 'nothing'"},
      {"HIERARCHY\nROOT a\nOFFSET 0 0 0\n", "a.bvh:3: expected {, found 'OFFSET'"},
      {"HIERARCHY\nJOINT a\n{\n", "a.bvh:2: expected ROOT or MOTION, found 'JOINT'"},
      {begin + "}\nEnd\n", "a.bvh:7: expected ROOT or MOTION, found 'End'"},
      {begin + "ROOT b\n{\n}\n",
       "a.bvh:6: expected OFFSET, CHANNELS, JOINT, End Site or }, found 'ROOT'"},
      {begin + "OFFSET 0 0 one\n", "a.bvh:6: expected three numbers after OFFSET, found 'one'"},
      {begin + "CHANNELS two\n", "a.bvh:6: expected 0 to 6 channels, found 'two'"},
      {begin + "CHANNELS 7\n", "a.bvh:6: expected 0 to 6 channels, found '7'"},
      {begin + "CHANNELS 1 Xrotation\n",
       "a.bvh:6: expected channels that differ, found 'Xrotation'"},
      {begin + "CHANNELS 2 Yrotation\n}\n",
       "a.bvh:7: expected a channel such as Xposition or Zrotation, found '}'"},
      {begin + "End Site\nOFFSET 0 0 0\n", "a.bvh:7: expected {, found 'OFFSET'"},
      {begin + "End Site\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n}\n",
       "a.bvh:9: expected an End Site without channels, found 'CHANNELS'"},
      {begin + "End Site\n{\nOFFSET 0 0 0\nJOINT b\n", "a.bvh:9: expected }, found 'JOINT'"},
      {begin + "}\nMOTION\n", "a.bvh:8: expected Frames:, found the end of the file"},
      {begin + "}\nMOTION\nRows: 3\n", "a.bvh:8: expected Frames:, found 'Rows:'"},
      {begin + "}\nMOTION\nFrames: -1\nFrame Time: 1\n",
       "a.bvh:8: expected the number of frames, found '-1'"},
      {begin + "}\nMOTION\nFrames: 1\n7\n", "a.bvh:9: expected Frame Time:, found '7'"},
      {begin + "}\nMOTION\nFrames: 1\nFrame Rate: 60\n",
       "a.bvh:9: expected Frame Time:, found 'Rate:'"},
      {begin + "}\nMOTION\nFrames: 1\nFrame Time: fast\n7\n",
       "a.bvh:9: expected a frame time above 0 s, found 'fast'"},
      {begin + "}\nMOTION\nFrames: 1\nFrame Time: 10001\n7\n",
       "a.bvh:9: expected a frame time above 0 s, found '10001'"},
      {"HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\n" + motion,
       "a.bvh:7: expected at least one channel, found none"}};
  for (const auto& [text, message] : refused) {
    CAPTURE(text);
    CHECK(fault(text) == message);
  }
  CHECK(fault(begin + motion) == "none");
}

TEST_CASE("no skeleton has more than 10000 joints or stands 500 deep") {
  std::string many = "HIERARCHY\nROOT a\n{\nCHANNELS 1 Xrotation\n", deep = many;
  for (int j = 1; j < 10'000; ++j) many += "JOINT b\n{\n}\n";
  CHECK(fault(many + motion) == "none");
  CHECK(fault(many + "JOINT b\n{\n}\n" + motion) ==
        "a.bvh:30002: expected at most 10000 joints, 500 deep, found 'one more'");
  for (int j = 1; j < 500; ++j) deep += "JOINT b\n{\n";
  CHECK(fault(deep + std::string(499, '}') + motion) == "none");
  CHECK(fault(deep + "JOINT b\n{\n}") ==
        "a.bvh:1003: expected at most 10000 joints, 500 deep, found 'one more'");
}

TEST_CASE("a frame of a second or longer may be a rate, and says so") {
  const auto file = read_bvh(begin + "}\nMOTION\nFrames: 1\nFrame Time: 60\n7\n", "a.bvh", {});
  REQUIRE(file);
  REQUIRE(file->findings.size() == 1);
  CHECK(file->findings[0].severity == Severity::warning);
  CHECK(to_string(file->findings[0].what) == "a.bvh:9: expected a frame time below 1 s, found 60");
  CHECK(file->findings[0].meaning == "the clip is read at less than one frame a second");
  CHECK(file->findings[0].repair == "if the number is a rate, write its inverse");
}

TEST_CASE("a head that does not end within 8 MiB is none, and is not kept for longer") {
  BvhHead head("a.bvh");
  Findings findings;
  std::string joints = begin;
  joints += std::string(1 << 20, '\n');
  Result<bool> whole = head.add(joints, findings);
  for (int i = 0; i < 7 && whole; ++i) {
    CHECK_FALSE(*whole);
    whole = head.add(std::string(1 << 20, '\n'), findings);
  }
  REQUIRE_FALSE(whole);
  CHECK(to_string(whole.error()).ends_with("found the end of the file"));
}

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
