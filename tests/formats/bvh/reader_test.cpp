// SPDX-License-Identifier: Apache-2.0
#include "tests/formats/bvh/bvh_text.h"

#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/motion/kinematics.h"

#include <doctest/doctest.h>

#include <numbers>
#include <string>

using namespace kinalign;

namespace {

const std::string one_joint =
    "HIERARCHY\nROOT Hips\n{\n\tOFFSET 0 90 0\n"
    "\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
    "\tEnd Site\n\t{\n\t\tOFFSET 0 10 0\n\t}\n}\n";

Result<BvhFile> read(const std::string& text) { return read_bvh(text, "walk.bvh", {}); }

std::string fault(const std::string& text) {
  const auto file = read(text);
  REQUIRE(!file);
  return to_string(file.error());
}

}  // namespace

TEST_CASE("a wrong frame count is a finding, not a failure") {
  const auto file = read(one_joint + "MOTION\nFrames: 2\nFrame Time: 0.01\n0 90 0 0 0 0\n");
  REQUIRE(file);
  CHECK(file->clip.frames.size() == 1);
  REQUIRE(file->findings.size() == 1);
  CHECK(to_string(file->findings[0].what) == "walk.bvh:12: expected 2 frames, found 1");
}

TEST_CASE("an incomplete last frame is dropped with a finding") {
  const auto file = read(one_joint + "MOTION\nFrames: 2\nFrame Time: 0.01\n0 90 0 0 0 0\n0 90 0 0");
  REQUIRE(file);
  CHECK(file->clip.frames.size() == 1);
  REQUIRE(file->findings.size() == 3);
  // The 0 may have been 0.5 before the file was cut.
  CHECK(file->findings[0].severity == Severity::note);
  CHECK(to_string(file->findings[0].what) ==
        "walk.bvh:15: expected a line end after the last value, found the end of the file");
  CHECK(to_string(file->findings[1].what) ==
        "walk.bvh:15: expected 6 values in the frame, found 4");
}

TEST_CASE("values are counted, not lines: rows may be wrapped or joined") {
  const std::string head = one_joint + "MOTION\nFrames: 3\nFrame Time: 0.01\n";
  for (const std::string rows :
       {"1 2 3 4 5 6\n7 8 9 10 11 12\n13 14 15 16 17 18\n",
        "1 2 3\n4 5 6\n7 8 9\n10 11 12\n13 14 15\n16 17 18\n",
        "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18\n",
        "1 2 3 4 5 6\n7 8 9 10\n11 12\n13 14 15 16 17 18\n",
        "1 2 3 4\n5 6 7 8\n9 10 11 12\n13 14 15 16\n17 18\n",
        "1\t2 3 4 5 6 \r\n\r\n7 8 9 10 11 12 \r\n13 14 15 16 17 18 \r\n"}) {
    CAPTURE(rows);
    const auto file = read(head + rows);
    REQUIRE(file);
    CHECK(file->findings.empty());
    REQUIRE(file->values.size() == 18);
    for (std::size_t i = 0; i < 18; ++i) CHECK(file->values[i] == static_cast<double>(i + 1));
  }
}

TEST_CASE("a row that lost a value is an error where frames stand on a line each") {
  CHECK(fault(one_joint +
              "MOTION\nFrames: 3\nFrame Time: 0.01\n1 2 3 4 5 6\n1 2 3 4 5\n1 2 3 4 5 6\n") ==
        "walk.bvh:15: expected 6 values in the frame, found 5");
  CHECK(fault(one_joint +
              "MOTION\nFrames: 3\nFrame Time: 0.01\n1 2 3 4 5 6\n1 2 3 4 5 6 7\n1 2 3 4 5 6\n") ==
        "walk.bvh:15: expected 6 values in the frame, found 7");
}

TEST_CASE("a text that is not a number is refused with its line") {
  const std::string head = one_joint + "MOTION\nFrames: 2\nFrame Time: 0.01\n";
  CHECK(fault(head + "0 90 0 0 nan 0\n") == "walk.bvh:14: expected a number, found 'nan'");
  CHECK(fault(head + "0 90 0 0 0,5 0\n") == "walk.bvh:14: expected a number, found '0,5'");
  CHECK(fault(head + "0 90 0 0 0 0\n0 9 0 inf 0 0\n") ==
        "walk.bvh:15: expected a number, found 'inf'");
  CHECK(fault(head + "0 90 0 0 1e999 0\n") == "walk.bvh:14: expected a number, found '1e999'");
  CHECK(fault(head + "0 90 0 0 0 0\n-1e15 9 0 0 0 0\n") ==
        "walk.bvh:15: expected a number, found '-1e15'");
  CHECK(fault("HIERARCHY\nROOT a\n{\nOFFSET 0 1e300 0\n}\n") ==
        "walk.bvh:4: expected three numbers after OFFSET, found '1e300'");
}

TEST_CASE("text behind the frames that were promised is left out with a finding") {
  const auto file = read(one_joint + "MOTION\nFrames: 1\nFrame Time: 0.01\n0 90 0 0 0 0\nMOTION\n");
  REQUIRE(file);
  CHECK(file->clip.frames.size() == 1);
  REQUIRE(file->findings.size() == 1);
  CHECK(to_string(file->findings[0].what) ==
        "walk.bvh:15: expected the end of the file, found 'MOTION'");
}

TEST_CASE("text behind the frames is left out wherever the file is cut into pieces") {
  const std::string text =
      one_joint + "MOTION\nFrames: 1\nFrame Time: 0.01\n0 90 0 0 0 0\n6m\n0\nm\n0\n";
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    CAPTURE(cut);
    const auto reader = make_bvh_reader({}, "walk.bvh");
    ClipFrames frames;
    REQUIRE(reader->feed(std::string_view(text).substr(0, cut), frames));
    REQUIRE(reader->feed(std::string_view(text).substr(cut), frames));
    REQUIRE(reader->finish(frames));
    CHECK(frames.size() == 1);
    CHECK(reader->findings.size() == 1);
  }
}

TEST_CASE("a hierarchy that can't be understood is refused where it goes wrong") {
  CHECK(fault("") == "walk.bvh:1: expected HIERARCHY, found the end of the file");
  CHECK(fault("\x7f"
              "ELF") == "walk.bvh:1: expected HIERARCHY, found '?ELF'");
  CHECK(fault("HIERARCHY\nROOT a\n{\nOFFSET 0 0\n}\n") ==
        "walk.bvh:5: expected three numbers after OFFSET, found '}'");
  CHECK(fault("HIERARCHY\nROOT a\n{\nCHANNELS 3 Xrotation Wrotation Zrotation\n}\n") ==
        "walk.bvh:4: expected a channel such as Xposition or Zrotation, found 'Wrotation'");
  CHECK(fault("HIERARCHY\nROOT a\n{\nCHANNELS 2 Xrotation Xrotation\n}\n") ==
        "walk.bvh:4: expected channels that differ, found 'Xrotation'");
  CHECK(fault("HIERARCHY\nROOT a\n{\n") ==
        "walk.bvh:4: expected OFFSET, CHANNELS, JOINT, End Site or }, found the end of the file");
  CHECK(fault("HIERARCHY\nMOTION\nFrames: 0\nFrame Time: 1\n") ==
        "walk.bvh:2: expected a ROOT before MOTION, found 'MOTION'");
  CHECK(fault(one_joint + "MOTION\nFrames: many\nFrame Time: 1\n") ==
        "walk.bvh:12: expected the number of frames, found 'many'");
  CHECK(fault(one_joint + "MOTION\nFrames: 1\nFrame Time: 0\n0 0 0 0 0 0\n") ==
        "walk.bvh:13: expected a frame time above 0 s, found '0'");
}

TEST_CASE("names with colons and blanks, any case, tabs, CRLF and odd numbers are read") {
  const auto file = read(
      "\xEF\xBB\xBFhierarchy\r\nRoot  mixamorig:Left Hip \r\n{\r\n\tOffset\t.5\t5.\t-1e-05\r\n"
      "\tCHANNELS 6 XPOSITION yposition Zposition Yrotation Xrotation Zrotation\r\n"
      "\tJoint\tarm {\r\n\t\tchannels 0\r\n\t\toffset 1 2 3\r\n"
      "\t\tEnd site\r\n\t\t{\r\n\t\t\tOFFSET 0 0 0\r\n\t\t\tCHANNELS 0\r\n\t\t}\r\n\t}\r\n}\r\n"
      "motion\r\nframes :\t1\r\nFrame Time :.0083333\r\n-.5 +2 3. -0.000000 1e2 720.25 \r\n");
  REQUIRE(file);
  CHECK(file->clip.skeleton.joint_names == std::vector<std::string>{"mixamorig:Left Hip", "arm"});
  CHECK(file->hierarchy.offsets[0] == Vec3(0.5, 5.0, -1e-5));
  CHECK(file->hierarchy.frame_seconds == 0.0083333);
  CHECK(file->values == std::vector<double>{-0.5, 2, 3, -0.0, 100, 720.25});
}

TEST_CASE("blank lines and control characters in front are no part of a BVH, as of no name") {
  CHECK(looks_like_bvh("\xEF\xBB\xBF\n\v\f\x01 \r\nHIERARCHY\n"));
  const auto file = read(
      "\n\x01\fHIERARCHY\nROOT \v\x01 a b\x02\f\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n}\n"
      "MOTION\nFrames: 0\nFrame Time: 0.01\n");
  REQUIRE(file);
  CHECK(file->hierarchy.names == std::vector<std::string>{"a b"});
}

TEST_CASE("a repeated name is made distinct, and written as it was") {
  const auto file = read(
      "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Xrotation Yrotation Zrotation\nJOINT b\n{\n"
      "OFFSET 1 0 0\n}\nJOINT b\n{\nOFFSET 2 0 0\n}\n}\nMOTION\nFrames: 0\nFrame Time: 0.01\n");
  REQUIRE(file);
  CHECK(file->clip.skeleton.joint_names == std::vector<std::string>{"a", "b", "b#2"});
  REQUIRE(file->findings.size() == 1);
  CHECK(file->findings[0].meaning == "read as 'b#2'");
  CHECK(written(*file).find("b#2") == std::string::npos);
}

TEST_CASE("a name from before UTF-8 is read as Latin-1, and written as it was") {
  const auto file = read(
      "HIERARCHY\nROOT H\xfc"
      "fte\n{\nOFFSET 0 0 0\nCHANNELS 3 Xrotation Yrotation Zrotation\n}\n"
      "MOTION\nFrames: 0\nFrame Time: 0.01\n");
  REQUIRE(file);
  CHECK(file->clip.skeleton.joint_names == std::vector<std::string>{"H\xc3\xbc"
                                                                    "fte"});
  CHECK(file->findings.empty());
  CHECK(written(*file).find("ROOT H\xfc"
                            "fte") != std::string::npos);
}

TEST_CASE("a repeated name counts on to one that no other joint has") {
  std::string joints;
  for (const std::string name : {"b", "b", "b#2", "b", "b#2"}) {
    joints += "JOINT " + name + "\n{\nOFFSET 1 0 0\n}\n";
  }
  const auto file = read("HIERARCHY\nROOT a\n{\nCHANNELS 1 Xrotation\n" + joints +
                         "}\nMOTION\nFrames: 0\nFrame Time: 0.01\n");
  REQUIRE(file);
  CHECK(file->clip.skeleton.joint_names ==
        std::vector<std::string>{"a", "b", "b#3", "b#2", "b#4", "b#2#2"});
  CHECK(validate(file->clip.skeleton));
  CHECK(file->findings.size() == 3);
}

TEST_CASE("several roots and zero frames are a skeleton") {
  const auto file = read(
      "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n}\n"
      "ROOT b\n{\nOFFSET 1 0 0\nCHANNELS 1 Yrotation\n}\nMOTION\nFrames: 0\nFrame Time: 0.01");
  REQUIRE(file);
  CHECK(file->clip.skeleton.parents == std::vector<int>{-1, -1});
  CHECK(file->clip.frames.size() == 0);
  CHECK(file->findings.empty());
}

TEST_CASE("position channels replace the offset, and an axis without one keeps it") {
  const auto file = read(
      "HIERARCHY\nROOT a\n{\nOFFSET 1 2 3\nCHANNELS 1 Yposition\nJOINT b\n{\nOFFSET 10 20 30\n"
      "CHANNELS 3 Zposition Xposition Yrotation\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.01\n"
      "50 300 100 90\n");
  REQUIRE(file);
  const auto& at = file->clip.frames.local_positions;
  CHECK(at[0] == doctest::Approx(0.01));
  CHECK(at[1] == doctest::Approx(0.5));
  CHECK(at[2] == doctest::Approx(0.03));
  CHECK(at[3] == doctest::Approx(1.0));
  CHECK(at[4] == doctest::Approx(0.2));
  CHECK(at[5] == doctest::Approx(3.0));
  const Quat q = quat(file->clip.frames.local_rotations, 1);
  CHECK(q.angularDistance(Quat(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY()))) < 1e-15);
}

TEST_CASE("a z-up file is turned upright") {
  BvhOptions options;
  options.z_up = true;
  const auto file = read_bvh(
      "HIERARCHY\nROOT a\n{\nOFFSET 0 0 90\nCHANNELS 6 Xposition Yposition Zposition Zrotation "
      "Xrotation Yrotation\nJOINT b\n{\nOFFSET 0 0 10\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.01\n"
      "1 2 90 0 0 0\n",
      "walk.bvh", options);
  REQUIRE(file);
  std::vector<double> global(6);
  forward_kinematics(file->clip.skeleton, file->clip.frames, global);
  const std::vector<double> upright{0.01, 0.9, -0.02, 0.01, 1.0, -0.02};
  for (std::size_t i = 0; i < 6; ++i) CHECK(global[i] == doctest::Approx(upright[i]));
}

TEST_CASE("a file cut into pieces anywhere gives the same frames") {
  const std::string text = one_joint +
                           "MOTION\nFrames: 3\nFrame Time: 0.01\n0 90 0 10.5 20.25 30\n"
                           "1 91 1 190.5 -20.25 -330\n2 92 2 -10.5 20.25 1e1";
  const auto whole = read(text);
  REQUIRE(whole);
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    for (const std::size_t second : {std::size_t{1}, std::size_t{7}, text.size()}) {
      const auto reader = make_bvh_reader({}, "walk.bvh");
      ClipFrames frames;
      REQUIRE(reader->feed(std::string_view(text).substr(0, cut), frames));
      std::string_view rest = std::string_view(text).substr(cut);
      while (!rest.empty()) {
        REQUIRE(reader->feed(rest.substr(0, second), frames));
        rest.remove_prefix(std::min(second, rest.size()));
      }
      REQUIRE(reader->finish(frames));
      CHECK(frames.local_rotations == whole->clip.frames.local_rotations);
      CHECK(frames.local_positions == whole->clip.frames.local_positions);
      CHECK(frames.stamps == whole->clip.frames.stamps);
      CHECK(reader->findings.size() == whole->findings.size());
    }
  }
}

TEST_CASE("cut short at any byte, a file is read or refused, and whole frames are never lost") {
  const std::string text =
      one_joint + "MOTION\nFrames: 2\nFrame Time: 0.01\n0 90 0 0 0 0\n1 91 1 0 0 0\n";
  const std::size_t second_row = text.size() - 13;
  for (std::size_t size = 0; size < text.size(); ++size) {
    const auto file = read(text.substr(0, size));
    if (size >= second_row) {
      REQUIRE(file);
      CHECK(file->clip.frames.size() >= 1);
    }
  }
}

TEST_CASE("a clip made elsewhere gets channels that give it back") {
  Clip clip;
  clip.skeleton = {
      {"a", "b", "c"}, {-1, 0, 1}, {Vec3(0, 1, 0), Vec3(0.1, 0, 0), Vec3(0, 0.2, 0)}, {}};
  for (int t = 0; t < 40; ++t) {
    clip.frames.stamps.push_back(utc_time(t * 10'000'000));
    for (int j = 0; j < 3; ++j) {
      const Vec3 at = clip.skeleton.rest_offsets[static_cast<std::size_t>(j)] +
                      (j == 2 ? Vec3(0.001 * t, 0, 0) : Vec3::Zero());
      for (int k = 0; k < 3; ++k) clip.frames.local_positions.push_back(at[k]);
      const Quat q(Eigen::AngleAxisd(0.3 * t + j, Vec3(1.0, 0.2 * t, -0.5 * j).normalized()));
      for (const double part : {q.w(), q.x(), q.y(), q.z()}) {
        clip.frames.local_rotations.push_back(part);
      }
    }
  }
  const BvhFile made = bvh_from_clip(clip, 0.01);
  CHECK(made.hierarchy.channels[1].size() == 3);
  CHECK(made.hierarchy.channels[2].size() == 6);  // the joint moves
  const auto back = read(written(made));
  REQUIRE(back);
  CHECK(back->values == made.values);
  for (std::size_t i = 0; i < 120; ++i) {
    const Quat q = quat(back->clip.frames.local_rotations, i);
    CHECK(q.angularDistance(quat(clip.frames.local_rotations, i)) <
          1e-7);  // 6 decimals of a degree
    const Vec3 apart = vec3(std::span<const double>(back->clip.frames.local_positions), i) -
                       vec3(std::span<const double>(clip.frames.local_positions), i);
    CHECK(apart.norm() < 1e-8);
  }
}
