// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/import/cmu_clips.h"

#include "kinalign/formats/archive/npz.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

// The units of the pack's whole numbers.
constexpr double metres_per_step = 0.0005, degrees_per_step = 0.015;
// Limits for archives, because a hostile one may unpack to far more bytes than it has.
constexpr ArchiveLimits largest_pack{
    .entries = 100, .bytes = std::uint64_t{512} << 20, .ratio = 1000};

/// The rotation Rz Ry Rx.
Quat turned(double x_deg, double y_deg, double z_deg) {
  constexpr double radians = std::numbers::pi / 180.0;
  return Quat(Eigen::AngleAxisd(z_deg * radians, Vec3::UnitZ()) *
              Eigen::AngleAxisd(y_deg * radians, Vec3::UnitY()) *
              Eigen::AngleAxisd(x_deg * radians, Vec3::UnitX()));
}

/// Converts second differences to values [C,F]. The differences are zigzag-coded, with low and high
/// bytes in [2,C,F]. Sums wrap around, as in the program that wrote the pack.
std::vector<std::int16_t> unpacked(const std::vector<std::int64_t>& planes, std::size_t channels,
                                   std::size_t frames) {
  std::vector<std::int16_t> out(channels * frames);
  for (std::size_t c = 0; c < channels; ++c) {
    // There are two running sums: differences give steps, and steps give values.
    std::uint16_t step = 0, value = 0;
    for (std::size_t f = 0; f < frames; ++f) {
      const std::size_t at = c * frames + f;
      // The low byte and the high byte are in two planes. The zigzag code makes small differences,
      // also negative ones, small numbers.
      const auto coded =
          static_cast<std::uint32_t>(planes[at] | planes[channels * frames + at] << 8);
      step = static_cast<std::uint16_t>(step + ((coded >> 1) ^ (0U - (coded & 1U))));
      value = static_cast<std::uint16_t>(value + step);
      out[at] = static_cast<std::int16_t>(value);
    }
  }
  return out;
}

/// `count` vectors of an array of numbers, from the vector `first` on.
std::vector<Vec3> vectors(const std::vector<double>& numbers, std::size_t first,
                          std::size_t count) {
  std::vector<Vec3> out;
  for (std::size_t i = first; i < first + count; ++i) out.emplace_back(vec3(numbers, i));
  return out;
}

/// The skeletons of all people. They have the same joints and end sites.
Result<std::vector<Skeleton>> read_skeletons(const Npz& npz, const std::string& name,
                                             std::size_t people) {
  // Names and parents are the same for all people; bone lengths differ.
  Skeleton body;
  body.joint_names = KA_TRY(npz.texts("joints", {0}));
  const std::size_t joints = body.joint_names.size();
  for (const std::int64_t parent : KA_TRY(npz.integers("parents", {joints}))) {
    body.parents.push_back(static_cast<int>(parent));
  }
  const auto ends = KA_TRY(npz.integers("tip_parents", {0}));
  const auto rest = KA_TRY(npz.numbers("rest", {people, joints, 3}));
  const auto tips = KA_TRY(npz.numbers("tips", {people, ends.size(), 3}));
  std::vector<Skeleton> out;
  for (std::size_t p = 0; p < people; ++p) {
    Skeleton& own = out.emplace_back(body);
    own.rest_offsets = vectors(rest, p * joints, joints);
    for (std::size_t e = 0; e < ends.size(); ++e) {
      if (ends[e] < 0 || static_cast<std::size_t>(ends[e]) >= joints) {
        return Failure(Error{name, 0, "joints in tip_parents", std::to_string(ends[e])});
      }
      own.end_sites.push_back({static_cast<int>(ends[e]), vec3(tips, p * ends.size() + e)});
    }
    // A pack may be damaged, so its skeletons are checked.
    if (auto sound = validate(own); !sound) {
      sound.error().file = name;
      return Failure(sound.error());
    }
  }
  return out;
}

/// Reads the list of clips. Each clip must name a person and a range of frames that exist.
Result<std::vector<PackedClip>> read_clips(const Npz& npz, const std::string& name,
                                           const std::vector<std::string>& people,
                                           std::size_t frames) {
  const auto takes = KA_TRY(npz.texts("clip_take", {0}));
  const std::size_t count = takes.size();
  const auto person = KA_TRY(npz.integers("clip_person", {count}));
  const auto begin = KA_TRY(npz.integers("clip_start", {count}));
  const auto length = KA_TRY(npz.integers("clip_len", {count}));
  const auto label = KA_TRY(npz.texts("clip_class", {count}));
  const auto text = KA_TRY(npz.texts("clip_text", {count}));
  // If a pack lacks this array, none of its clips is in another pack.
  const auto same = npz.has("clip_same") ? KA_TRY(npz.texts("clip_same", {count}))
                                         : std::vector<std::string>(count);
  std::vector<PackedClip> out;
  for (std::size_t k = 0; k < count; ++k) {
    const auto all = static_cast<std::int64_t>(frames);
    const bool fits = person[k] >= 0 && person[k] < static_cast<std::int64_t>(people.size()) &&
                      begin[k] >= 0 && begin[k] <= all && length[k] > 0 &&
                      length[k] <= all - begin[k];
    if (!fits) {
      return Failure(
          Error{name, 0, fmt::format("clips among {} people and {} frames", people.size(), frames),
                fmt::format("clip {} of person {}, {} frames from {}", k, person[k], length[k],
                            begin[k])});
    }
    const auto body = static_cast<std::size_t>(person[k]);
    out.push_back({people[body], takes[k], label[k], text[k], same[k], body,
                   static_cast<std::size_t>(begin[k]), static_cast<std::size_t>(length[k])});
  }
  return out;
}

/// The axes of each person's joints, from angles in degrees.
Result<std::vector<std::vector<Quat>>> read_axes(const Npz& npz, std::size_t people,
                                                 std::size_t joints) {
  const auto axes = KA_TRY(npz.numbers("axis", {people, joints, 3}));
  std::vector<std::vector<Quat>> out(people);
  for (std::size_t p = 0; p < people; ++p) {
    for (const Vec3& angles : vectors(axes, p * joints, joints)) {
      out[p].push_back(turned(angles.x(), angles.y(), angles.z()));
    }
  }
  return out;
}

/// Reads the rate. A rate beyond the limits is refused, because all stamps would be wrong.
Result<double> read_rate(const Npz& npz, const std::string& name) {
  const double rate_hz = KA_TRY(npz.numbers("rate", {})).front();
  if (rate_hz >= 1.0 && rate_hz <= 1e4) return rate_hz;
  return Failure(Error{name, 0, "a rate of 1 to 10,000 Hz", std::to_string(rate_hz)});
}

}  // namespace

Result<PackedClips> PackedClips::read(const ArchiveBytes& bytes) {
  const Npz npz = KA_TRY(Npz::read(bytes, largest_pack));
  PackedClips out;
  const auto people = KA_TRY(npz.texts("people", {0}));
  if (people.empty()) return Failure(Error{bytes.name, 0, "people", "none"});
  out.skeletons_ = KA_TRY(read_skeletons(npz, bytes.name, people.size()));
  // All skeletons have the same joints.
  const std::size_t joints = out.skeletons_.front().joints();
  out.axes_ = KA_TRY(read_axes(npz, people.size(), joints));
  const std::size_t channels = 3 + 3 * joints;
  {
    // The planes need more memory than the values, so they are freed as soon as possible.
    const auto planes = KA_TRY(npz.integers("planes", {2, channels, 0}));
    out.frames_ = planes.size() / (2 * channels);
    out.values_ = unpacked(planes, channels, out.frames_);
  }
  out.clips_ = KA_TRY(read_clips(npz, bytes.name, people, out.frames_));
  // If a pack states no rate, it has 60 Hz.
  if (npz.has("rate")) out.frame_seconds_ = 1.0 / KA_TRY(read_rate(npz, bytes.name));
  return out;
}

/// Rebuilds the clip's frames; angles are about each joint's own axes.
Clip PackedClips::clip(const PackedClip& packed) const {
  Clip out;
  out.skeleton = skeletons_[packed.body];
  const std::size_t joints = out.skeleton.joints();
  const std::vector<Quat>& axes = axes_[packed.body];
  ClipFrames& to = out.frames;
  to.local_positions.reserve(packed.frames * joints * 3);
  to.local_rotations.resize(packed.frames * joints * 4);
  for (std::size_t t = 0; t < packed.frames; ++t) {
    // Channels are rows of the array, frames are columns.
    const auto value = [&](std::size_t channel) {
      return static_cast<double>(values_[channel * frames_ + packed.begin + t]);
    };
    to.stamps.push_back(Time{} +
                        Duration{std::llround(1e9 * frame_seconds_ * static_cast<double>(t))});
    for (std::size_t j = 0; j < joints; ++j) {
      Vec3 at = out.skeleton.rest_offsets[j];
      // Only the root moves; all other joints keep their offsets.
      if (j == 0) at += metres_per_step * Vec3(value(0), value(1), value(2));
      to.local_positions.insert(to.local_positions.end(), at.begin(), at.end());
      const std::size_t c = 3 + 3 * j;
      const Quat angles = turned(degrees_per_step * value(c), degrees_per_step * value(c + 1),
                                 degrees_per_step * value(c + 2));
      put_quat(to.local_rotations, t * joints + j, axes[j] * angles * axes[j].conjugate());
    }
  }
  return out;
}

}  // namespace kinalign
