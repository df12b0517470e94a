// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/opensim/mot_write.h"

#include "tests/formats/written_text.h"
#include "tests/seeds.h"
#include "tests/witness.h"

#include <doctest/doctest.h>

#include <string>

using namespace kinalign;

namespace {

Result<std::string> mot_of(const Clip& clip, std::uint64_t frames, Time zero = {}) {
  return written_text([&](TextOut& out) -> Result<void> {
    auto writer = KA_TRY(MotWriter::begin({clip.skeleton, frames, zero}, out));
    KA_TRY(writer.append(clip.frames));
    return writer.finish();
  });
}

std::string refusal(const Clip& clip, std::uint64_t frames) {
  const auto text = mot_of(clip, frames);
  return text ? "" : to_string(text.error());
}

/// Two joints, one frame: the root at (1, 2, 3) m turned by 90 degrees about z, its child 0.5 m
/// along the root's y.
Clip bent() {
  Clip clip;
  clip.skeleton = {{"Hips", "Spine"}, {-1, 0}, {Vec3::Zero(), Vec3(0, 0.5, 0)}, {}};
  clip.frames.stamps = {utc_time(7'500'000'000)};
  clip.frames.local_positions = {1, 2, 3, 0, 0.5, 0};
  const double half = std::sqrt(0.5);
  clip.frames.local_rotations = {half, 0, 0, half, 1, 0, 0, 0};
  return clip;
}

/// A tree whose joints J0, J1, ... turn in any way; 100 Hz.
Clip any_clip(std::size_t joints, std::size_t frames, std::mt19937_64& random) {
  std::normal_distribution<double> any;
  Clip clip;
  for (std::size_t j = 0; j < joints; ++j) {
    clip.skeleton.joint_names.push_back("J" + std::to_string(j));
    clip.skeleton.parents.push_back(j == 0 ? -1 : static_cast<int>(random() % j));
    clip.skeleton.rest_offsets.emplace_back(0.3 * any(random), 0.3 * any(random),
                                            0.3 * any(random));
  }
  for (std::size_t t = 0; t < frames; ++t) {
    clip.frames.stamps.push_back(utc_time(10'000'000 * static_cast<std::int64_t>(t)));
    for (std::size_t j = 0; j < joints; ++j) {
      const Vec3 at =
          j == 0 ? Vec3(any(random), any(random), any(random)) : clip.skeleton.rest_offsets[j];
      clip.frames.local_positions.insert(clip.frames.local_positions.end(), {at[0], at[1], at[2]});
      const Quat q = Quat(any(random), any(random), any(random), any(random)).normalized();
      clip.frames.local_rotations.insert(clip.frames.local_rotations.end(),
                                         {q.w(), q.x(), q.y(), q.z()});
    }
  }
  return clip;
}

}  // namespace

TEST_CASE("a .mot of joint angles has the roots' positions and three angles a joint in degrees") {
  CHECK(mot_of(bent(), 1, utc_time(7'000'000'000)).value() ==
        "Coordinates\nversion=1\nnRows=1\nnColumns=10\ninDegrees=yes\nendheader\n"
        "time\tHips_tx\tHips_ty\tHips_tz\tHips_rz\tHips_rx\tHips_ry\tSpine_rz\tSpine_rx\tSpine_ry\n"
        "0.5\t1.000000\t2.000000\t3.000000\t90.000000\t0.000000\t0.000000\t0.000000\t0.000000\t"
        "0.000000\n");
}

TEST_CASE("NumPy and SciPy read from a .mot the rotations and places that were given") {
  for (const std::uint64_t seed : fresh_seeds(3)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::size_t joints = 2 + random() % 12, frames = 1 + random() % 50;
    const Clip clip = any_clip(joints, frames, random);
    const FreshFolder folder;
    const auto put = [&](const char* name, const std::vector<double>& values) {
      folder.write(name, {reinterpret_cast<const char*>(values.data()), 8 * values.size()});
    };
    std::vector<double> parents, root;
    for (const int parent : clip.skeleton.parents) parents.push_back(parent);
    for (std::size_t t = 0; t < frames; ++t) {
      for (std::size_t k = 0; k < 3; ++k)
        root.push_back(clip.frames.local_positions[3 * joints * t + k]);
    }
    put("parents.in", parents);
    put("root.in", root);
    put("rotations.in", clip.frames.local_rotations);
    folder.write("angles.mot", mot_of(clip, frames).value());
    CHECK(run_witness("mot_read.py", folder.path()) == 0);
  }
}

TEST_CASE("what a .mot can't hold is refused") {
  Clip clip = bent();
  CHECK(refusal(clip, 2) == "expected 2 frames for a .mot, found 1");
  clip.skeleton.joint_names[1] = "Left Arm";
  CHECK(refusal(clip, 1) ==
        "expected names of joints for a .mot without tabs and blanks, found 'Left Arm'");
  CHECK(refusal({}, 0) == "expected at least one joint for a .mot, found none");
}
