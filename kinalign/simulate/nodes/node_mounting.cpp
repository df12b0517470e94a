// SPDX-License-Identifier: Apache-2.0
// Random numbers (random.h): stream 114 of a seed, by the number of the node, has these lanes: 0
// the position along the bone, 1 to 3 the displacement, 4 to 6 the axis and 8 the angle of the
// rotation. Lengths are in cm for a person with a shank of 41.87 cm.
#include "kinalign/motion/index_of.h"
#include "kinalign/motion/rotation.h"
#include "kinalign/simulate/nodes/inertial_nodes.h"
#include "kinalign/simulate/random.h"

#include <numbers>
#include <string_view>

namespace kinalign {

namespace {

// The usual place of a node on the body. `mounted` draws the deviation of a node from that place.
struct Worn {
  std::string_view node, joint, end;  // the bone goes from `joint` to `end`; `end` empty: upwards
  double from_cm, to_cm;              // along the bone, for a shank of 41.87 cm
  bool from_end;                      // measured from the end of the bone
  Vec3 outward;                       // away from the body, in the rest pose
  double outward_cm;                  // distance from the bone's axis
};

std::array<Worn, 5> worn() {
  const Vec3 up = Vec3::UnitY(), back = -Vec3::UnitZ();
  const Vec3 left = Vec3(0.6, 0.0, 0.8), right = Vec3(-0.6, 0.0, 0.8);  // to the front and outwards
  return {{{"waist", "Hips", "", 5.0, 5.0, false, back, 10.0},
           {"wrist_left", "LeftForeArm", "LeftHand", 3.0, 5.0, true, up, 3.0},
           {"wrist_right", "RightForeArm", "RightHand", 3.0, 5.0, true, up, 3.0},
           {"ankle_left", "LeftLeg", "LeftFoot", 10.0, 20.0, false, left, 5.0},
           {"ankle_right", "RightLeg", "RightFoot", 10.0, 20.0, false, right, 5.0}}};
}

// The error names the joint that the skeleton lacks.
Result<std::size_t> needed_joint(const Skeleton& skeleton, std::string_view name) {
  if (const auto joint = index_of(skeleton.joint_names, name)) return *joint;
  return Failure(Error{"", 0, "a skeleton with a joint " + std::string(name) + " to wear a node on",
                       "no such joint"});
}

/// The bone on which a node is worn.
struct Bone {
  std::size_t joint = 0;
  Vec3 way = Vec3::UnitY();  // m, vector to its end
  double scale = 1.0;        // size of the person; 1: a shank of 41.87 cm
};

/// Returns the mounting of a node with random position along the bone, displacement and rotation.
Mounting mounted(const Worn& where, const Bone& bone, const RandomStream& random,
                 std::uint64_t number) {
  const auto near = [&](std::uint64_t lane) { return 2.0 * random.uniform(number, lane) - 1.0; };
  const double m = 0.01 * bone.scale;
  const Vec3 along = bone.way.normalized();
  const double cm = where.from_cm + (where.to_cm - where.from_cm) * random.uniform(number, 0);
  Vec3 at = m * cm * along;
  if (where.from_end) at = bone.way - at;
  at += m * (where.outward_cm * where.outward + Vec3(near(1), near(2), near(3)));
  Eigen::Matrix3d axes;
  // x points along the bone, z away from the body.
  axes << along, where.outward.cross(along), where.outward;
  const Vec3 axis = Vec3(near(4), near(5), near(6)).normalized();
  const double angle = std::numbers::pi / 12.0 * random.uniform(number, 8);
  return {std::string(where.node), bone.joint, at, Quat(axes) * rotation(Vec3(angle * axis))};
}

}  // namespace

Result<std::vector<Mounting>> five_nodes(const Skeleton& skeleton, std::uint64_t seed) {
  const RandomStream random(seed, 114);
  const std::size_t shank = KA_TRY(needed_joint(skeleton, "LeftFoot"));
  const double scale = skeleton.rest_offsets[shank].norm() / 0.4187;
  std::vector<Mounting> mountings;
  for (const Worn& where : worn()) {
    Bone bone{KA_TRY(needed_joint(skeleton, where.joint)), Vec3::UnitY(), scale};
    if (!where.end.empty()) {
      bone.way = skeleton.rest_offsets[KA_TRY(needed_joint(skeleton, where.end))];
    }
    mountings.push_back(mounted(where, bone, random, mountings.size()));
  }
  return mountings;
}

}  // namespace kinalign
