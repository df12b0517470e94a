// SPDX-License-Identifier: Apache-2.0
#include "kinalign/check/value_survey.h"

#include "kinalign/motion/arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

// least number of points of a person, and of frames or samples for a mean
constexpr std::uint64_t enough = 10;

/// Wide limits. If metres are taken for centimetres or the reverse, the size is outside. Children
/// and two people in one volume are inside.
constexpr double smallest_m = 0.2, largest_m = 20.0;
/// Greatest step of a walking root joint from frame to frame, at 30 Hz. The joints of a hand are at
/// least 6 cm from its wrist.
constexpr double longest_step_m = 0.05;
/// A node at rest measures 9.8 m/s2. On a runner's shank the mean is 20 m/s2.
constexpr double least_with_gravity = 6.0, most_acceleration = 40.0;
/// Limbs rotate by 1 to 5 rad/s on average. Degrees that are read as radians are 57 times larger.
constexpr double most_angular_velocity = 12.0;

}  // namespace

void MeanSize::add(double size) {
  ++count;
  sum += size;
  squares += size * size;
}

double MeanSize::deviation() const {
  return std::sqrt(std::max(0.0, squares / static_cast<double>(count) - mean() * mean()));
}

/// Counts the frames in which a joint is at zero, if it was far from zero before or after. Such
/// zeros mark a joint that was not seen. If a joint moves to zero in small steps, the position is
/// real.
void PointSizes::Seen::add(const Vec3& at) {
  if (at.isZero(0.0)) {
    ++now_at_zero;
    return;
  }
  const bool comes_far = at.squaredNorm() > longest_step_m * longest_step_m;
  if (far || comes_far) lost_at_zero += now_at_zero;
  now_at_zero = 0;
  elsewhere = true;
  far = comes_far;
}

/// Counts the states of points and measures the box around the points of each frame.
void PointSizes::add(const PointFrames& block) {
  if (block.size() == 0) return;
  const std::size_t joints = block.state.size() / block.size();
  all_frames_ += block.size();
  joints_.resize(joints);
  for (std::size_t t = 0; t < block.size(); ++t) {
    // An axis-aligned box suffices. Its diagonal is 1 to 1.7 times the size of the body.
    Eigen::AlignedBox3d box;
    std::uint64_t seen = 0;
    for (std::size_t cell = t * joints; cell < (t + 1) * joints; ++cell) {
      if (block.state[cell] == Tracking::missing) continue;
      // Inferred points count as seen, because the device gave them a position.
      ++(block.state[cell] == Tracking::tracked ? tracked_ : inferred_);
      const Vec3 at = vec3(block.positions, cell);
      joints_[cell - t * joints].add(at);
      box.extend(at);
      ++seen;
    }
    seen_frames_ += seen > 0 ? 1 : 0;
    if (seen < 2) continue;
    most_points_ = std::max(most_points_, seen);
    const double diagonal_m = box.diagonal().norm();
    (diagonal_m > largest_m ? far_ : person_).add(diagonal_m);
  }
}

Findings PointSizes::judge(const PointHeader& header, const std::string& file) const {
  FileFindings out{file};
  // With so few points no other property can be judged.
  if (all_frames_ >= enough && 10 * seen_frames_ < all_frames_) {
    out.add(Severity::warning, "at least one frame in ten with a point",
            fmt::format("{} of {}", seen_frames_, all_frames_), "the other frames have no points",
            "look at the cells that are empty");
    return out.all;
  }
  judge_seen(header, out);
  judge_marks(header, out);
  judge_unit(out);
  return out.all;
}

/// Makes findings about points that were never tracked or never seen. Both are allowed, but rarely
/// intended.
void PointSizes::judge_seen(const PointHeader& header, FileFindings& out) const {
  if (inferred_ >= enough && tracked_ == 0) {
    out.add(Severity::warning, "points that were tracked",
            fmt::format("none, but {} inferred points", inferred_),
            "a fit uses only tracked points",
            "if they were tracked, state the value for tracked under [state] of a layout");
  }
  std::size_t never = 0;
  std::string first;
  for (std::size_t j = 0; j < joints_.size() && j < header.joint_names.size(); ++j) {
    if (joints_[j].seen()) continue;
    if (never++ == 0) first = shown(header.joint_names[j]);
  }
  if (never > 0 && all_frames_ >= enough) {
    out.add(Severity::note, "points that were seen at least once",
            fmt::format("{} of {} never seen, the first is '{}'", never, joints_.size(), first),
            "they are invalid in every row",
            "if 0, 0, 0 is a valid position of this point, such as a root, use a layout without "
            "missing_point");
  }
}

/// Makes findings about points at exactly zero or far away, which writers use as marks for "not
/// seen". Some files use a body's root, or the first position of its root, as the origin. A point
/// at the origin is always at zero or moves away steadily, and is no fault. If several joints are
/// always at zero, they can't all be the origin.
void PointSizes::judge_marks(const PointHeader& header, FileFindings& out) const {
  // Number of joints that were seen only at zero. One of them may be the file's origin.
  const auto stays = std::count_if(joints_.begin(), joints_.end(),
                                   [](const Seen& j) { return j.seen() && !j.elsewhere; });
  std::uint64_t at_zero = 0;
  std::string first;
  for (std::size_t j = 0; j < joints_.size() && j < header.joint_names.size(); ++j) {
    const Seen& joint = joints_[j];
    // Several joints that stay at zero can't all be the origin, so they were never seen.
    const bool never_seen = !joint.elsewhere && stays > 1;
    const std::uint64_t zeros = never_seen ? joint.now_at_zero : joint.lost();
    if (at_zero == 0 && zeros > 0) first = shown(header.joint_names[j]);
    at_zero += zeros;
  }
  if (at_zero > 0) {
    out.add(Severity::warning, "points at measured positions",
            fmt::format("{} at exactly 0, 0, 0, the first of '{}'", at_zero, first),
            "read as places, as they stand there",
            "if 0, 0, 0 means not seen, set missing_point = [0, 0, 0] in a layout");
  }
  // If most frames are too wide, the unit is wrong, which judge_unit() reports.
  if (far_.count > 0 && far_.count <= person_.count) {
    out.add(Severity::warning, "the points of a frame within 20 m",
            fmt::format("{} of {} frames with points farther apart, {:.0f} m on average",
                        far_.count, far_.count + person_.count, far_.mean()),
            "read as places, as they stand there",
            "if a number means not seen, set missing_point in a layout");
  }
}

/// Makes a finding if the points of a frame are too far apart or too close together for a person.
void PointSizes::judge_unit(FileFindings& out) const {
  if (far_.count + person_.count < enough) return;
  // The mean diagonal of the larger group of frames is taken as the size of the person.
  const double size = (far_.count > person_.count ? far_ : person_).mean();
  if (size <= largest_m && (size >= smallest_m || most_points_ < enough)) return;
  std::string meaning = "they all lie in one place", repair;
  if (size > 0.0) {
    // The power of ten by which the size is too large for a person.
    const double times = std::pow(10.0, std::round(std::log10(size / 1.7)));
    meaning = times > 1.0 ? fmt::format("lengths are about {:g} times too large", times)
                          : fmt::format("lengths are about {:g} times too small", 1.0 / times);
    repair = fmt::format("multiply metres_per_unit of this stream by {:g}, in a manifest or layout",
                         1.0 / times);
  }
  out.add(Severity::warning, "the points of a frame 0.2 to 20 m apart",
          size < 1000.0 ? fmt::format("{:.3g} m", size) : fmt::format("{:.0f} m", size), meaning,
          repair);
}

void ImuSizes::add(std::span<const double> vectors, const ImuSamples& block, MeanSize& lengths) {
  for (std::size_t cell = 0; 3 * cell < vectors.size(); ++cell) {
    if (block.valid[cell] == 0) continue;
    lengths.add(vec3(vectors, cell).norm());
  }
}

/// Adds the lengths of the vectors. The orientations are compared with the vectors themselves.
void ImuSizes::add(const ImuSamples& block) {
  samples_ += block.valid.size();
  valid_ += static_cast<std::uint64_t>(std::count(block.valid.begin(), block.valid.end(), 1));
  add(block.acceleration, block, acceleration_);
  add(block.angular_velocity, block, angular_velocity_);
  orientation_.add(block);
}

Findings ImuSizes::judge(const ImuHeader& header, const std::string& file) const {
  const bool gravity = header.content.gravity;
  FileFindings out{file};
  // All findings about units have the same effect: the values are used as they are in the file.
  const auto find = [&out](const char* expected, const std::string& found, const char* repair) {
    out.add(Severity::warning, expected, found, "the values are used unchanged", repair);
  };
  if (samples_ >= enough && 10 * valid_ < samples_) {
    out.add(Severity::warning, "at least one valid sample in ten",
            fmt::format("{} of {}", valid_, samples_),
            "the other samples are invalid, because a quantity is missing",
            "look at the cells that are empty");
  }
  if (acceleration_.count >= enough) {
    const double mean = acceleration_.mean();
    const std::string found = fmt::format("{:.3g} m/s2", mean);
    // Without gravity the acceleration of a limb is small, or large for short times. With gravity
    // it is steady and about 9.8 m/s2 on average.
    const bool steady = mean > 8.5 && mean < 12.0 && acceleration_.deviation() < 0.5 * mean;
    if (mean > most_acceleration || (gravity && mean < least_with_gravity)) {
      find(gravity ? "accelerations with gravity of 6 to 40 m/s2 on average"
                   : "accelerations of at most 40 m/s2 on average",
           found, "set acceleration_unit = \"g\" (or \"m/s2\"), or gravity = false, in a layout");
    } else if (!gravity && steady) {
      find("accelerations without gravity", found + " on average",
           "if the values contain gravity, set gravity = true in a layout");
    }
  }
  if (angular_velocity_.count >= enough && angular_velocity_.mean() > most_angular_velocity) {
    find("angular velocities of at most 12 rad/s on average",
         fmt::format("{:.3g} rad/s", angular_velocity_.mean()),
         "set angular_velocity_unit = \"deg/s\" in a layout");
  }
  orientation_.judge(header, out);
  return out.all;
}

}  // namespace kinalign
