// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/space.h"

#include "kinalign/core/nearest_name.h"
#include "kinalign/motion/index_of.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

/// Returns the joint names of a group. Nodes have no joints, so the result is nullptr for nodes.
const std::vector<std::string>* joint_names(const TakeGroup& group) {
  if (const auto* clip = std::get_if<ClipGroup>(&group.kind)) return &clip->skeleton.joint_names;
  if (const auto* points = std::get_if<PointGroup>(&group.kind)) return &points->joint_names;
  return nullptr;
}

Result<std::size_t> find_group(const TakeHeader& header, const std::string& name) {
  std::vector<std::string> known;
  // Only groups with joints are possible, and the error lists only these groups.
  for (std::size_t g = 0; g < header.groups.size(); ++g) {
    if (joint_names(header.groups[g]) == nullptr) continue;
    if (header.groups[g].name == name) return g;
    known.push_back(header.groups[g].name);
  }
  return Failure(unknown_name(name, "a stream with joints in [space]", known));
}

/// Returns the index of a joint. `line`: the manifest's line that names the joint, or 0.
Result<std::size_t> known_joint(const TakeGroup& group, const std::string& name,
                                std::int64_t line) {
  const auto& names = *joint_names(group);
  if (const auto j = index_of(names, name)) return *j;
  Error error = unknown_name(name, "a joint of '" + group.name + "'", names);
  error.kind = ErrorKind::no_such_joint;
  error.line = line;
  return Failure(std::move(error));
}

/// Returns the pairs that the user names, or else the usual pairs, or else joints with equal names.
/// If a joint that the user names does not exist, that is an error. Usual pairs without both joints
/// are omitted.
Result<std::vector<JointPair>> find_pairs(const TakeGroup& from, const TakeGroup& onto,
                                          const SpaceOptions& options) {
  std::vector<JointPair> pairs;
  for (const auto& [a, b] : options.joints) {
    const std::int64_t line = line_of(options.lines, "joints");
    const std::size_t other = KA_TRY(known_joint(onto, b, line));
    // Two joints can't both correspond to one joint, and a fit would count that joint twice.
    const auto same = [other](const JointPair& pair) { return pair.onto == other; };
    if (std::any_of(pairs.begin(), pairs.end(), same)) {
      return Failure(
          Error{"", line, "different joints of '" + onto.name + "'", "'" + shown(b) + "' twice"});
    }
    pairs.push_back({KA_TRY(known_joint(from, a, line)), other});
  }
  if (!pairs.empty()) return pairs;
  const auto &theirs = *joint_names(onto), &ours = *joint_names(from);
  const auto add = [&](std::string_view a, std::string_view b) {
    const auto from_joint = index_of(ours, a), onto_joint = index_of(theirs, b);
    if (from_joint && onto_joint) pairs.push_back({*from_joint, *onto_joint});
  };
  // The usual pairs are tried before equal names. Both skeletons have a Neck and a Head, but at
  // different places.
  for (const auto& [a, b] : usual_pairs()) add(a, b);
  if (pairs.empty()) {
    for (const std::string& name : ours) add(name, name);
  }
  return pairs;
}

/// Returns the transform that the options state, or the identity if the transform will be fitted.
Result<RigidTransform> given_transform(const SpaceOptions& options) {
  RigidTransform out;
  if (options.method == "paper") out.rotation = turn_about_y(options.rotation_y_deg);
  if (options.method != "given") return out;
  if (!options.rotation.empty()) {
    // A quaternion whose length is far from 1 is a mistake, such as angles. Small deviations are
    // normalised.
    const Quat q = quat(options.rotation, 0);
    if (!(q.norm() > 0.5 && q.norm() < 2.0)) {
      return Failure(Error{"", 0, "a unit quaternion w,x,y,z as rotation", "another length"});
    }
    out.rotation = q.normalized();
  }
  if (!options.translation.empty()) out.translation = vec3(std::span(options.translation), 0);
  return out;
}

/// Global positions and validity of the joints of one group in a slab.
struct JointColumn {
  std::span<const double> positions;
  std::span<const std::uint8_t> valid;  // by row and joint, or by row; empty: all are valid
  std::span<const Tracking> state;      // empty: all are tracked
  std::size_t joints = 0;

  // A skeleton has one validity per row, points have one per joint.
  bool usable(std::size_t row, std::size_t j) const {
    if (!state.empty() && state[row * joints + j] != Tracking::tracked) return false;
    if (valid.empty()) return true;
    return valid[state.empty() ? row : row * joints + j] != 0;
  }
  Vec3 at(std::size_t row, std::size_t j) const { return vec3(positions, row * joints + j); }
};

/// Returns a view of the slab's arrays. It is valid until the slab changes.
JointColumn column(const TakeSlab& slab, std::size_t group) {
  JointColumn out;
  if (const auto* clip = std::get_if<ClipRows>(&slab.rows[group])) {
    out = {clip->positions, clip->valid, {}, 0};
  } else {
    const auto& points = std::get<PointRows>(slab.rows[group]);
    out = {points.positions, points.valid, points.state, 0};
  }
  out.joints = out.positions.size() / 3 / slab.stamps.size();
  return out;
}

/// Checks that points are moved onto a stream that is not moved itself. Otherwise the result would
/// depend on the order of the moves.
Result<void> check_method(const SpacePlan& plan, const TakeHeader& header,
                          const Manifest& manifest) {
  const TakeGroup &from = header.groups[plan.group], &onto = header.groups[plan.onto];
  if (plan.group == plan.onto || !std::holds_alternative<PointGroup>(from.kind)) {
    return Failure(Error{"", 0, "points to be moved onto another stream", "'" + from.name + "'"});
  }
  const auto moved = manifest.spaces.find(onto.name);
  if (moved != manifest.spaces.end() && moved->second.method != "none") {
    return Failure(Error{"", 0, "'" + from.name + "' onto a stream that is not moved itself",
                         "'" + onto.name + "'"});
  }
  return {};
}

/// "1 (SpineBase on Hips)": the pairs that were found, for a message.
std::string pairs_text(const TakeGroup& from, const TakeGroup& onto,
                       const std::vector<JointPair>& pairs) {
  if (pairs.empty()) return "none";
  std::string names;
  for (const JointPair& pair : pairs) {
    names += (names.empty() ? "" : ", ") + shown((*joint_names(from))[pair.from]) + " on " +
             shown((*joint_names(onto))[pair.onto]);
  }
  return std::to_string(pairs.size()) + " (" + names + ")";
}

/// Finds the pairs of joints of a space. For the method "paper" it also finds the two root joints.
Result<void> find_joints(const TakeHeader& header, SpacePlan& plan) {
  const TakeGroup &from = header.groups[plan.group], &onto = header.groups[plan.onto];
  plan.pairs = KA_TRY(find_pairs(from, onto, plan.options));
  if (plan.options.method == "paper") {
    const KeyLines& lines = plan.options.lines;
    plan.root = {KA_TRY(known_joint(from, plan.options.root, line_of(lines, "root"))),
                 KA_TRY(known_joint(onto, plan.options.onto_root, line_of(lines, "onto_root")))};
  }
  // A rigid transform is determined by three points that are not on a line.
  if (plan.options.method == "fit" && plan.pairs.size() < 3) {
    return Failure(Error{"", line_of(plan.options.lines, "joints"),
                         "at least three pairs of joints for a fit (joints = { ... })",
                         pairs_text(from, onto, plan.pairs), ErrorKind::too_few_joints});
  }
  return {};
}

/// Moves the points of a row. In the HFUT-MMD paper x' = m (A_rot x - A_offset) with A_offset =
/// A_rot x_k0 - x_d0 / m, which moves the root x_k0 to x_d0. If the root was not seen in a row, the
/// points of that row become missing.
void move_row(const SpacePlan& plan, const JointColumn& onto, std::size_t row, std::size_t joints,
              PointRows& points) {
  RigidTransform transform = plan.transform;
  double m = 1.0;
  bool placed = true;
  // The method "paper" moves each row separately, so both roots must be valid in that row. A fitted
  // or given transform is the same in every row.
  if (plan.options.method == "paper") {
    m = plan.options.magnification;
    const std::size_t root = row * joints + plan.root.from;
    placed = points.valid[root] != 0 && onto.usable(row, plan.root.onto);
    transform.translation = onto.at(row, plan.root.onto) / m -
                            transform.rotation * vec3(std::span(points.positions), root);
  }
  for (std::size_t cell = row * joints; cell < (row + 1) * joints; ++cell) {
    if (points.valid[cell] == 0) continue;
    auto p = vec3(std::span(points.positions), cell);
    if (placed) {
      p = (m * (transform * p)).eval();
    } else {
      // By definition missing points are zero.
      p.setZero();
      points.valid[cell] = 0;
      points.state[cell] = Tracking::missing;
    }
  }
}

}  // namespace

Quat turn_about_y(double degrees) {
  return Quat(Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, Vec3::UnitY()));
}

std::vector<std::pair<std::string_view, std::string_view>> usual_pairs() {
  // Joints at the same place in both skeletons: Kinect v2 and Perception Neuron; then segments of
  // Xsens MVN, which have the place of the joint at which they begin; then skeletons whose joints
  // have the names of joints.
  return {{"SpineBase", "Hips"},
          {"ShoulderLeft", "LeftArm"},
          {"ElbowLeft", "LeftForeArm"},
          {"WristLeft", "LeftHand"},
          {"ShoulderRight", "RightArm"},
          {"ElbowRight", "RightForeArm"},
          {"WristRight", "RightHand"},
          {"HipLeft", "LeftUpLeg"},
          {"KneeLeft", "LeftLeg"},
          {"AnkleLeft", "LeftFoot"},
          {"HipRight", "RightUpLeg"},
          {"KneeRight", "RightLeg"},
          {"AnkleRight", "RightFoot"},
          {"SpineBase", "Pelvis"},
          {"ShoulderLeft", "LeftUpperArm"},
          {"ShoulderRight", "RightUpperArm"},
          {"HipLeft", "LeftUpperLeg"},
          {"HipRight", "RightUpperLeg"},
          {"KneeLeft", "LeftLowerLeg"},
          {"KneeRight", "RightLowerLeg"},
          {"ElbowLeft", "LeftElbow"},
          {"WristLeft", "LeftWrist"},
          {"HipLeft", "LeftHip"},
          {"KneeLeft", "LeftKnee"},
          {"AnkleLeft", "LeftAnkle"},
          {"ElbowRight", "RightElbow"},
          {"WristRight", "RightWrist"},
          {"HipRight", "RightHip"},
          {"KneeRight", "RightKnee"},
          {"AnkleRight", "RightAnkle"}};
}

/// Plans the spaces in the order of the stream names. Streams with the method "none" keep their own
/// space.
Result<std::vector<SpacePlan>> plan_spaces(const TakeHeader& header, const Manifest& manifest,
                                           std::size_t reference_group) {
  std::vector<SpacePlan> plans;
  for (const auto& [name, options] : manifest.spaces) {
    if (options.method == "none") continue;
    SpacePlan plan;
    plan.options = options;
    plan.group = KA_TRY(find_group(header, name));
    plan.onto = options.onto.empty() ? reference_group : KA_TRY(find_group(header, options.onto));
    KA_TRY(check_method(plan, header, manifest));
    KA_TRY(find_joints(header, plan));
    plan.transform = KA_TRY(given_transform(options));
    plans.push_back(std::move(plan));
  }
  return plans;
}

void add_pairs(const SpacePlan& plan, const TakeSlab& slab, PairMoments& moments) {
  const JointColumn from = column(slab, plan.group), onto = column(slab, plan.onto);
  for (std::size_t r = 0; r < slab.stamps.size(); ++r) {
    for (const JointPair& pair : plan.pairs) {
      if (from.usable(r, pair.from) && onto.usable(r, pair.onto)) {
        moments.add(from.at(r, pair.from), onto.at(r, pair.onto));
      }
    }
  }
}

/// The sums before and after the move must include the same points. Both use the validity after the
/// move, because the move may make points invalid.
void ResidualSums::transform(const SpacePlan& plan, TakeSlab& slab) {
  auto& points = std::get<PointRows>(slab.rows[plan.group]);
  const std::vector<double> before = points.positions;
  const JointColumn onto = column(slab, plan.onto);
  for (std::size_t r = 0; r < slab.stamps.size(); ++r) {
    move_row(plan, onto, r, points.valid.size() / slab.stamps.size(), points);
  }
  const JointColumn is = column(slab, plan.group);
  const JointColumn was{before, is.valid, is.state, is.joints};
  for (std::size_t k = 0; k < plan.pairs.size(); ++k) {
    const JointPair& pair = plan.pairs[k];
    for (std::size_t r = 0; r < slab.stamps.size(); ++r) {
      if (!is.usable(r, pair.from) || !onto.usable(r, pair.onto)) continue;
      ++rows_[k];
      before_[k] += (was.at(r, pair.from) - onto.at(r, pair.onto)).squaredNorm();
      after_[k] += (is.at(r, pair.from) - onto.at(r, pair.onto)).squaredNorm();
    }
  }
}

SpaceReport ResidualSums::report(const SpacePlan& plan, const TakeHeader& header) const {
  SpaceReport out;
  out.stream = header.groups[plan.group].name;
  out.onto = header.groups[plan.onto].name;
  out.method = plan.options.method;
  out.transform = plan.transform;
  out.magnification = plan.options.magnification;
  const auto& ours = *joint_names(header.groups[plan.group]);
  const auto& theirs = *joint_names(header.groups[plan.onto]);
  // A pair that is never tracked has no distance. It gets 0 for 0 rows.
  const auto rms = [](double square, std::uint64_t n) {
    return n == 0 ? 0.0 : std::sqrt(square / static_cast<double>(n));
  };
  std::uint64_t rows = 0;
  double before = 0.0, after = 0.0;
  for (std::size_t k = 0; k < plan.pairs.size(); ++k) {
    out.joints.push_back({ours[plan.pairs[k].from], theirs[plan.pairs[k].onto], rows_[k],
                          rms(before_[k], rows_[k]), rms(after_[k], rows_[k])});
    rows += rows_[k];
    before += before_[k];
    after += after_[k];
  }
  out.before_m = rms(before, rows);
  out.after_m = rms(after, rows);
  std::stable_sort(out.joints.begin(), out.joints.end(),
                   [](const auto& a, const auto& b) { return a.after_m > b.after_m; });
  return out;
}

}  // namespace kinalign
