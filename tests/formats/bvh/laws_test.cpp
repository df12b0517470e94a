// SPDX-License-Identifier: Apache-2.0
// Rules for BVH files of random skeletons: any channels of any joint, several roots, wrapped rows,
// any letter case and blanks.
#include "tests/folder.h"
#include "tests/formats/bvh/any_bvh.h"
#include "tests/formats/bvh/bvh_text.h"
#include "tests/seeds.h"

#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/motion/kinematics.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace kinalign;

namespace {

BvhFile read(const std::string& text) {
  auto file = read_bvh(text, "any.bvh", {});
  REQUIRE_MESSAGE(file, (file ? "" : to_string(file.error())));
  return *std::move(file);
}

std::vector<std::string> texts_of(const Findings& findings) {
  std::vector<std::string> out;
  for (const Finding& finding : findings) out.push_back(to_string(finding.what));
  return out;
}

/// The outcome of reading a whole file: an error or findings, and the number of frames.
struct Said {
  std::vector<std::string> words;
  std::uint64_t frames = 0;
};

Said by_reading(const std::string& text, const std::string& path) {
  const auto file = read_bvh(text, path, {});
  if (!file) return {{to_string(file.error())}, 0};
  return {texts_of(file->findings), file->clip.frames.size()};
}

Said by_survey(const std::string& path) {
  PosixFiles files;
  const auto survey = survey_bvh(files, path, {}, {});
  if (!survey) return {{to_string(survey.error())}, 0};
  return {texts_of(survey->findings), survey->survey.samples};
}

}  // namespace

TEST_CASE("any skeleton, written in any way, is read completely") {
  for (const std::uint64_t seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const AnyBvh any = make_any_bvh(random);
    CAPTURE(any.text);
    const BvhFile file = read(any.text);
    CHECK(file.findings.empty());
    CHECK(file.hierarchy.names == any.hierarchy.names);
    CHECK(file.hierarchy.parents == any.hierarchy.parents);
    CHECK(file.hierarchy.offsets == any.hierarchy.offsets);
    CHECK(file.hierarchy.channels == any.hierarchy.channels);
    CHECK(file.hierarchy.frames == any.frames);
    CHECK(file.values == any.values);
    CHECK(file.clip.frames.size() == any.frames);
    CHECK(file.clip.skeleton.joint_names == any.hierarchy.names);
    REQUIRE(file.hierarchy.end_sites.size() == any.hierarchy.end_sites.size());
    const auto by_parent = [](const EndSite& a, const EndSite& b) { return a.parent < b.parent; };
    auto sites = file.hierarchy.end_sites;
    std::stable_sort(sites.begin(), sites.end(), by_parent);
    for (std::size_t e = 0; e < sites.size(); ++e) {
      CHECK(sites[e].parent == any.hierarchy.end_sites[e].parent);
      CHECK(sites[e].offset == any.hierarchy.end_sites[e].offset);
    }
  }
}

TEST_CASE("what was read is written to the same numbers, and written again to the same text") {
  for (const std::uint64_t seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const AnyBvh any = make_any_bvh(random);
    CAPTURE(any.text);
    const std::string once = written(read(any.text));
    const BvhFile again = read(once);
    CHECK(again.values == any.values);
    CHECK(again.hierarchy.offsets == any.hierarchy.offsets);
    CHECK(again.hierarchy.frame_time == any.hierarchy.frame_time);
    CHECK(again.findings.empty());
    CHECK(written(again) == once);
  }
}

TEST_CASE("joints are where matrices, multiplied channel by channel, put them") {
  for (const std::uint64_t seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const AnyBvh any = make_any_bvh(random);
    const BvhFile file = read(any.text);
    std::vector<double> global(file.clip.frames.local_positions.size());
    forward_kinematics(file.clip.skeleton, file.clip.frames, global);
    const std::size_t joints = any.hierarchy.names.size();
    for (std::size_t t = 0; t < any.frames; ++t) {
      const auto places = places_of(any, t);
      for (std::size_t j = 0; j < joints; ++j) {
        const Vec3 place = vec3(std::span<const double>(global), t * joints + j);
        CHECK((place - places[j]).norm() < 1e-12);
      }
    }
  }
}

TEST_CASE("frames are stamped by the file's step from the first, each rounded by itself") {
  for (const std::uint64_t seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const AnyBvh any = make_any_bvh(random);
    BvhOptions options;
    options.start = utc_time(1'700'000'000'000'000'000);
    const auto file = read_bvh(any.text, "any.bvh", options);
    REQUIRE(file);
    for (std::size_t t = 0; t < any.frames; ++t) {
      CHECK(to_ns(file->clip.frames.stamps[t]) ==
            1'700'000'000'000'000'000 + std::llround(static_cast<double>(t) * 8'333'300.0));
    }
  }
}

TEST_CASE("a survey counts and says what reading finds, of sound files and of cut ones") {
  const FreshFolder folder;
  for (const std::uint64_t seed : fresh_seeds(60)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::string text = make_any_bvh(random).text;
    const std::uint64_t kind = random() % 4;
    if (kind == 0) text.resize(random() % (text.size() + 1));
    if (kind == 1) text.resize(text.size() - std::min<std::size_t>(1 + random() % 4, text.size()));
    if (kind == 2) text += "7 ";
    CAPTURE(text);
    const std::string path = folder.write("any.bvh", text);
    const Said read = by_reading(text, path), surveyed = by_survey(path);
    CHECK(surveyed.words == read.words);
    CHECK(surveyed.frames == read.frames);
  }
}
