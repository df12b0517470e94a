// SPDX-License-Identifier: Apache-2.0
// How far a take's Kinect, and skeletons that were made of the take, lie from its suit:
//
//   kinalign_motion_table TAKE NAME=FILE.bvh ...
//
// A row for the Kinect and for each file: the mean distance of 12 joints of arms and legs, in the
// room and about the middle of the hips, cm. Files begin with the take.
#include "kinalign/core/files.h"
#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/models/fuse/fuse_features.h"
#include "kinalign/motion/kinect_map.h"
#include "kinalign/motion/kinematics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

namespace {

constexpr std::size_t most_bvh_bytes = std::size_t{1} << 30U;

/// The first two are the hips, whose middle is used.
constexpr std::array<std::string_view, 12> compared{
    "HipLeft",    "HipRight",   "ShoulderLeft", "ElbowLeft", "WristLeft", "ShoulderRight",
    "ElbowRight", "WristRight", "KneeLeft",     "AnkleLeft", "KneeRight", "AnkleRight"};
using Places = std::array<Vec3, compared.size()>;

/// Positions of the compared joints, m, at times in s from the take's first stamp.
struct TimedPlaces {
  std::vector<double> seconds;
  std::vector<Places> places;
};

std::size_t kinect_index(std::string_view name) {
  return static_cast<std::size_t>(std::find(kinect_joints.begin(), kinect_joints.end(), name) -
                                  kinect_joints.begin());
}

double seconds_from(Time start, Time stamp) {
  return static_cast<double>(to_ns(stamp) - to_ns(start)) * 1e-9;
}

/// The positions of the Kinect's joints on a suit's skeleton.
Result<TimedPlaces> of_suit(const Take& take, const ClipGroup& group, const ClipRows& rows) {
  const KinectMap map = KA_TRY(kinect_map(group.skeleton));
  const std::size_t joints = group.skeleton.joints();
  TimedPlaces out;
  Pose pose;
  GlobalPose global;
  std::array<double, 3 * kinect_joints.size()> all{};
  for (std::size_t t = 0; t < take.all.stamps.size(); ++t) {
    pose.local_positions.clear();
    pose.local_rotations.clear();
    for (std::size_t j = 0; j < joints; ++j) {
      pose.local_positions.emplace_back(vec3(rows.local_positions, t * joints + j));
      pose.local_rotations.push_back(quat(rows.local_rotations, t * joints + j));
    }
    forward_kinematics(group.skeleton, pose, global);
    kinect_positions(map, global, all);
    out.seconds.push_back(seconds_from(take.all.stamps.front(), take.all.stamps[t]));
    Places& places = out.places.emplace_back();
    for (std::size_t k = 0; k < compared.size(); ++k) {
      places[k] = Eigen::Map<const Vec3>(&all[3 * kinect_index(compared[k])]);
    }
  }
  return out;
}

/// The file's joint with that Kinect name, or the joint of a pose's body at the same place.
std::optional<std::size_t> joint_of(const Skeleton& skeleton, std::string_view kinect) {
  const auto& names = skeleton.joint_names;
  auto at = std::find(names.begin(), names.end(), kinect);
  for (const FuseJoint& joint : fuse_joints) {
    if (at == names.end() && joint.kinect == kinect) {
      at = std::find(names.begin(), names.end(), joint.body);
    }
  }
  if (at == names.end()) return std::nullopt;
  return static_cast<std::size_t>(at - names.begin());
}

Result<TimedPlaces> of_bvh(FileSystem& files, const std::string& path) {
  const BvhFile file = KA_TRY(read_bvh(KA_TRY(read_whole(files, path, most_bvh_bytes)), path, {}));
  const std::size_t joints = file.clip.skeleton.joints();
  TimedPlaces out;
  Pose pose;
  GlobalPose global;
  for (std::size_t t = 0; t < file.clip.frames.size(); ++t) {
    pose.local_positions.clear();
    pose.local_rotations.clear();
    for (std::size_t j = 0; j < joints; ++j) {
      pose.local_positions.emplace_back(vec3(file.clip.frames.local_positions, t * joints + j));
      pose.local_rotations.push_back(quat(file.clip.frames.local_rotations, t * joints + j));
    }
    forward_kinematics(file.clip.skeleton, pose, global);
    out.seconds.push_back(static_cast<double>(t) * file.hierarchy.frame_seconds);
    Places& places = out.places.emplace_back();
    for (std::size_t k = 0; k < compared.size(); ++k) {
      const auto joint = joint_of(file.clip.skeleton, compared[k]);
      if (!joint) {
        return Failure(Error{path, 0, "a joint " + std::string(compared[k]), "none"});
      }
      places[k] = global.positions[*joint];
    }
  }
  return out;
}

struct Apart {
  double room_cm = 0.0, hips_cm = 0.0;
};

/// The distances at the times of `other`, each to the suit's nearest frame.
Apart apart_of(const TimedPlaces& suit, const TimedPlaces& other) {
  Apart out;
  double count = 0.0;
  for (std::size_t t = 0; t < other.seconds.size(); ++t) {
    const auto next =
        std::lower_bound(suit.seconds.begin(), suit.seconds.end(), other.seconds[t] - 0.5 / 60.0);
    if (next == suit.seconds.end()) break;
    const Places& truth = suit.places[static_cast<std::size_t>(next - suit.seconds.begin())];
    const Places& said = other.places[t];
    const Vec3 moved = 0.5 * (truth[0] + truth[1]) - 0.5 * (said[0] + said[1]);
    for (std::size_t k = 0; k < compared.size(); ++k) {
      out.room_cm += 100.0 * (said[k] - truth[k]).norm();
      out.hips_cm += 100.0 * (said[k] + moved - truth[k]).norm();
      count += 1.0;
    }
  }
  return {out.room_cm / count, out.hips_cm / count};
}

TimedPlaces of_kinect(const Take& take, const PointGroup& group, const PointRows& rows) {
  TimedPlaces out;
  const std::size_t joints = group.joint_names.size();
  for (std::size_t t = 0; t < take.all.stamps.size(); ++t) {
    if (rows.state[t * joints] == Tracking::missing) continue;
    out.seconds.push_back(seconds_from(take.all.stamps.front(), take.all.stamps[t]));
    Places& places = out.places.emplace_back();
    for (std::size_t k = 0; k < compared.size(); ++k) {
      const auto at = std::find(group.joint_names.begin(), group.joint_names.end(), compared[k]);
      places[k] = vec3(rows.positions,
                       t * joints + static_cast<std::size_t>(at - group.joint_names.begin()));
    }
  }
  return out;
}

void print_row(const std::string& name, const Apart& apart) {
  std::fputs(fmt::format("{} {:.1f} {:.1f}\n", name, apart.room_cm, apart.hips_cm).c_str(), stdout);
}

Result<void> run(const std::vector<std::string>& words) {
  PosixFiles files;
  const Take take = KA_TRY(read_take(files, words[0]));
  std::optional<TimedPlaces> suit, kinect;
  for (std::size_t g = 0; g < take.header.groups.size(); ++g) {
    const TakeGroup& group = take.header.groups[g];
    if (const auto* clip = std::get_if<ClipGroup>(&group.kind)) {
      suit = KA_TRY(of_suit(take, *clip, std::get<ClipRows>(take.all.rows[g])));
    } else if (const auto* points = std::get_if<PointGroup>(&group.kind)) {
      kinect = of_kinect(take, *points, std::get<PointRows>(take.all.rows[g]));
    }
  }
  if (!suit) return Failure(Error{words[0], 0, "a take with a suit", "none"});
  if (kinect) print_row("kinect", apart_of(*suit, *kinect));
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::size_t equals = words[i].find('=');
    const TimedPlaces file = KA_TRY(of_bvh(files, words[i].substr(equals + 1)));
    print_row(words[i].substr(0, equals), apart_of(*suit, file));
  }
  return {};
}

}  // namespace

}  // namespace kinalign

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty()) {
    std::fputs("usage: kinalign_motion_table TAKE NAME=FILE.bvh ...\n", stderr);
    return 2;
  }
  const auto done = kinalign::run(words);
  if (done) return 0;
  std::fprintf(stderr, "%s\n", kinalign::to_string(done.error()).c_str());
  return 3;
}
