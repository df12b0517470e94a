// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/page/node_figures.h"

#include "kinalign/motion/index_of.h"
#include "kinalign/motion/rotation.h"
#include "kinalign/view/page/body_figures.h"

#include <Eigen/SVD>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

namespace kinalign {

namespace {

constexpr double standard_gravity = 9.80665;  // m/s2
constexpr double half_window_s = 0.05;        // passes up to 8 Hz, half of the rate of a 15 Hz node
constexpr double most_lag_s = 0.25;
// With fewer rows, the fitted rotations could explain almost any difference.
constexpr std::size_t fewest_rows = 20;  // least number of rows for a comparison

// ---- bones by name

/// Words in a node's name, and the usual names of its joints. "*" means the side.
struct Wear {
  std::vector<std::string_view> words, turns, place;
};

/// The order matters. Of the entries with a word in the name, the first entry whose joints exist is
/// used.
const std::vector<Wear>& wears() {
  static const std::vector<Wear> all{
      {{"waist", "pelvis", "hips"}, {"Hips", "Pelvis", "hip"}, {"Hips", "Pelvis", "hip"}},
      {{"wrist", "forearm", "lowerarm", "lowarm", "hand"},
       {"*ForeArm", "*Forearm", "*LowerArm", "*Elbow"},
       {"*Hand", "*Wrist", "*ForeArm"}},
      {{"ankle", "shank", "shin", "lowerleg", "lowleg"},
       {"*Leg", "*LowerLeg", "*Knee"},
       {"*Foot", "*Ankle", "*Leg"}},
      {{"foot", "shoe", "toe"}, {"*Foot", "*Ankle"}, {"*Foot", "*Ankle"}},
      {{"upperarm", "uparm", "elbow", "arm", "shoulder"},
       {"*Arm", "*UpperArm", "*Shoulder"},
       {"*Arm", "*UpperArm", "*Shoulder"}},
      {{"thigh", "upperleg", "upleg", "knee", "leg", "hip"},
       {"*UpLeg", "*UpperLeg", "*Hip"},
       {"*UpLeg", "*UpperLeg", "*Hip"}},
      {{"head"}, {"Head"}, {"Head"}},
      {{"chest", "sternum", "torso", "spine"},
       {"Spine3", "Spine2", "Chest"},
       {"Spine3", "Spine2", "Chest"}},
      {{"back", "trunk"}, {"Spine2", "Spine1", "Spine"}, {"Spine2", "Spine1", "Spine"}},
  };
  return all;
}

/// Returns the letters of a name in lower case: "Wrist_L" gives "wristl". Digits and separators are
/// removed.
std::string plain(const std::string& name) {
  std::string out;
  for (const char c : name) {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return out;
}

/// Returns the side in a name: "Left" or "Right" for "wrist_left", "L_Foot", "shank_r"; otherwise
/// empty. A single letter counts only next to an underscore, because "arm" contains an "r" and
/// "lab" an "l".
std::string_view side_of(const std::string& name) {
  const std::string text = plain(name);
  const auto has = [&](std::string_view word, std::string_view letters) {
    const auto is_letter = [letters](char c) { return letters.find(c) != std::string_view::npos; };
    if (text.find(word) != std::string::npos) return true;
    if (name.size() < 2) return false;
    return (is_letter(name.front()) && name[1] == '_') ||
           (is_letter(name.back()) && name[name.size() - 2] == '_');
  };
  if (has("left", "lL")) return "Left";
  return has("right", "rR") ? "Right" : "";
}

/// Returns the first joint that matches a pattern. Patterns with a side need a side in the node's
/// name.
std::optional<std::size_t> joint_called(std::span<const std::string_view> patterns,
                                        std::string_view side,
                                        const std::vector<std::string>& joints) {
  for (const std::string_view pattern : patterns) {
    std::string name(pattern);
    if (name.front() == '*') {
      if (side.empty()) continue;
      name = std::string(side) + name.substr(1);
    }
    const auto found = std::find(joints.begin(), joints.end(), name);
    if (found != joints.end()) return static_cast<std::size_t>(found - joints.begin());
  }
  return std::nullopt;
}

// ---- fits of rotations and curves

/// Returns the rotation R that maximises the sum of to . R from. `cross` is the sum of to * from^T
/// (Wahba's problem; Markley 1988).
Quat best_rotation(const Eigen::Matrix3d& cross) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double turn = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  const Eigen::Matrix3d rotation = svd.matrixU() *
                                   Vec3(1.0, 1.0, turn < 0.0 ? -1.0 : 1.0).asDiagonal() *
                                   svd.matrixV().transpose();
  return Quat(rotation).normalized();
}

using Matrix4 = Eigen::Matrix4d;

/// Returns the matrix M with p * q = M q, q as w,x,y,z. A product of quaternions is linear in each
/// factor, so such a matrix exists.
Matrix4 left_of(const Quat& p) {
  Matrix4 m;
  m << p.w(), -p.x(), -p.y(), -p.z(), p.x(), p.w(), -p.z(), p.y(), p.y(), p.z(), p.w(), -p.x(),
      p.z(), -p.y(), p.x(), p.w();
  return m;
}

/// Returns the matrix M with q * p = M q, q as w,x,y,z.
Matrix4 right_of(const Quat& p) {
  Matrix4 m;
  m << p.w(), -p.x(), -p.y(), -p.z(), p.x(), p.w(), p.z(), -p.y(), p.y(), -p.z(), p.w(), p.x(),
      p.z(), p.y(), -p.x(), p.w();
  return m;
}

Quat quat_of(const Eigen::Vector4d& v) { return Quat(v[0], v[1], v[2], v[3]).normalized(); }

/// The orientations of node and bone in one row.
struct OrientationPair {
  Quat node, bone;
};

/// Constant rotations of world and sensor: node = world * bone * sensor.
struct OrientationFit {
  Quat world = Quat::Identity(), sensor = Quat::Identity();
  Quat predicted(const Quat& bone) const { return world * bone * sensor; }
};

/// Minimises the sum of |world^-1 node - bone sensor|^2 over both unit quaternions, using the
/// largest singular value of a 4 x 4 matrix. Three repetitions determine the signs of the
/// quaternions.
OrientationFit fit_orientation(std::vector<OrientationPair> pairs) {
  OrientationFit fit;
  for (int round = 0; round < 3; ++round) {
    Matrix4 sum = Matrix4::Zero();
    for (const OrientationPair& p : pairs) sum += left_of(p.bone).transpose() * right_of(p.node);
    const Eigen::JacobiSVD<Matrix4> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
    fit.world = quat_of(svd.matrixV().col(0)).conjugate();
    fit.sensor = quat_of(svd.matrixU().col(0));
    // This sign of the sensor makes the sum of node . (world bone sensor) positive.
    bool flipped = false;
    for (OrientationPair& p : pairs) {
      if (p.node.dot(fit.predicted(p.bone)) >= 0.0) continue;
      p.node.coeffs() = -p.node.coeffs();
      flipped = true;
    }
    if (!flipped) break;
  }
  return fit;
}

/// The sums for Pearson's correlation. Magnitudes of vectors are compared, because rotations do not
/// change them.
struct Correlation {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  void add(double a, double b) { n += 1, x += a, y += b, xx += a * a, yy += b * b, xy += a * b; }
  double value() const {
    const double vx = n * xx - x * x, vy = n * yy - y * y;
    return vx > 0.0 && vy > 0.0 ? (n * xy - x * y) / std::sqrt(vx * vy) : 0.0;
  }
};

/// The weights of values at `times` that give the slope and the second derivative of a fitted
/// parabola at time 0.
struct Weights {
  std::vector<double> slope, bend;
};
/// Computes the weights by least squares, from the normal equations of 1, t and t^2. Times are
/// relative to the middle row, so time 0 is that row.
Weights parabola(std::span<const double> times) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  for (const double t : times) {
    const Vec3 powers(1.0, t, t * t);
    normal += powers * powers.transpose();
  }
  const Eigen::Matrix3d inverse = normal.inverse();
  Weights out;
  for (const double t : times) {
    const Vec3 weights = inverse * Vec3(1.0, t, t * t);
    out.slope.push_back(weights[1]);
    out.bend.push_back(2.0 * weights[2]);
  }
  return out;
}

/// A signal of a node and that of its bone, over the rows in which both are known. Other rows are
/// zero, so that all series have the same number of rows.
struct SignalFit {
  std::vector<float> node, bone;  // [K,3]; both in the node's axes
  double rms = 0.0, correlation = 0.0;
};

}  // namespace

std::optional<WornOn> worn_on(const std::string& node, const std::vector<std::string>& joints) {
  const std::string text = plain(node);
  const std::string_view side = side_of(node);
  for (const Wear& wear : wears()) {
    const bool here = std::any_of(wear.words.begin(), wear.words.end(), [&](std::string_view word) {
      return text.find(word) != std::string::npos;
    });
    if (!here) continue;
    const auto turns = joint_called(wear.turns, side, joints);
    const auto place = joint_called(wear.place, side, joints);
    if (turns && place) return WornOn{*turns, *place};
  }
  return std::nullopt;
}

// A quantity that the group does not have stays 0 or the identity.
std::vector<NodeReading> node_readings(const ImuGroup& group, const ImuRows& rows,
                                       std::size_t row) {
  const std::size_t nodes = group.node_names.size();
  std::vector<NodeReading> out(nodes);
  for (std::size_t s = 0; s < nodes; ++s) {
    const std::size_t at = row * nodes + s;
    out[s].valid = rows.valid[at] != 0;
    if (!out[s].valid) continue;
    if (group.content.orientation) out[s].orientation = quat(rows.orientation, at).normalized();
    if (group.content.angular_velocity) out[s].rate = vec3(rows.angular_velocity, at);
    if (group.content.acceleration) out[s].acceleration = vec3(rows.acceleration, at);
  }
  // Values in the root's space are converted back. The other nodes' orientations are relative to
  // the root's, and the root's acceleration was subtracted from theirs.
  if (group.root_node.empty() || !group.content.orientation) return out;
  const auto root = index_of(group.node_names, group.root_node);
  if (!root) return out;
  for (std::size_t s = 0; s < nodes; ++s) {
    NodeReading& node = out[s];
    if (s == *root || !node.valid || !out[*root].valid) continue;
    const Quat to_node = node.orientation.conjugate();  // rotates from the root's space
    node.rate = to_node * node.rate;
    node.acceleration = to_node * (node.acceleration + out[*root].acceleration);
    node.orientation = out[*root].orientation * node.orientation;
  }
  return out;
}

BoneReading bone_reading(std::span<const TimedPose* const> poses, std::size_t middle,
                         const WornOn& bone) {
  std::vector<double> times;
  for (const TimedPose* p : poses) times.push_back(p->seconds - poses[middle]->seconds);
  const Weights weights = parabola(times);
  BoneReading out;
  out.rotation = poses[middle]->pose.rotations[bone.turns];
  // Differences from the middle are small numbers, so the second derivative stays precise.
  const Vec3 here = poses[middle]->pose.positions[bone.place];
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const GlobalPose& pose = poses[i]->pose;
    out.rate +=
        weights.slope[i] * rotation_vector(out.rotation.conjugate() * pose.rotations[bone.turns]);
    out.acceleration += weights.bend[i] * (pose.positions[bone.place] - here);
  }
  out.acceleration = out.rotation.conjugate() * out.acceleration;
  return out;
}

/// If the name of a node does not give its bone, all joints of the skeleton are candidates.
NodeCompare::NodeCompare(const ImuGroup& group, const Skeleton& skeleton, double rate_hz)
    : group_(group),
      skeleton_(skeleton),
      half_window_(
          static_cast<std::size_t>(std::clamp(std::llround(half_window_s * rate_hz), 1LL, 200LL))),
      longest_step_s_(rate_hz > 0.0 ? 3.0 / rate_hz : 1.0) {
  bool all_named = true;
  for (const std::string& node : group.node_names) {
    named_.push_back(worn_on(node, skeleton.joint_names));
    candidates_.push_back(named_.back().value_or(WornOn{}));
    all_named = all_named && named_.back();
  }
  for (std::size_t j = 0; !all_named && j < skeleton.joints(); ++j) candidates_.push_back({j, j});
}

void NodeCompare::add(double seconds, const ClipRows& clip, const ImuRows& nodes, std::size_t row,
                      bool keep) {
  Waiting& now = waiting_.emplace_back();
  now.pose.seconds = seconds;
  pose_of_row(skeleton_, clip, row, now.pose.pose);
  now.known = clip.valid.empty() || clip.valid[row] != 0;
  now.keep = keep;
  if (keep) now.nodes = node_readings(group_, nodes, row);
  // A row can be computed when half_window_ rows follow.
  while (waiting_.size() > next_ + half_window_) settle_next();
  while (next_ > half_window_) {
    waiting_.pop_front();
    --next_;
  }
}

/// Computes the readings of a row's bones when the rows after it have come. If there is a gap
/// within the window, the readings stay unknown.
void NodeCompare::settle_next() {
  const std::size_t middle = next_++;
  Waiting& row = waiting_[middle];
  if (!row.keep) return;
  Kept& kept = kept_.emplace_back();
  // A row without readings is stored too, so that all series have the same rows.
  kept.nodes = std::move(row.nodes);
  const std::size_t first = middle - std::min(middle, half_window_);
  const std::size_t last = std::min(middle + half_window_, waiting_.size() - 1);
  std::vector<const TimedPose*> poses;
  for (std::size_t i = first; i <= last; ++i) {
    if (!waiting_[i].known) return;
    const double step = poses.empty() ? 0.0 : waiting_[i].pose.seconds - poses.back()->seconds;
    if (step > longest_step_s_) return;
    poses.push_back(&waiting_[i].pose);
  }
  // A parabola needs three points.
  if (poses.size() < 3) return;
  for (const WornOn& bone : candidates_) {
    kept.bones.push_back(bone_reading(poses, middle - first, bone));
  }
}

/// Returns the candidate for a node: the bone by name, or else the bone whose rotation is most
/// similar.
std::size_t NodeCompare::candidate_of(std::size_t node) const {
  if (named_[node]) return node;
  std::size_t best = 0;
  double most = -2.0;
  for (std::size_t c = group_.node_names.size(); c < candidates_.size(); ++c) {
    const double here = alike(node, c);
    if (here <= most) continue;
    most = here;
    best = c;
  }
  return best;
}

/// Returns the correlation of the magnitudes of both angular velocities, over all stored rows.
double NodeCompare::alike(std::size_t node, std::size_t candidate) const {
  Correlation sums;
  for (const Kept& row : kept_) {
    if (row.bones.empty() || !row.nodes[node].valid) continue;
    sums.add(row.nodes[node].rate.norm(), row.bones[candidate].rate.norm());
  }
  return sums.value();
}

/// Returns the joint of another node whose rotation is clearly more similar to this node's than its
/// own bone's; otherwise empty. Only bones that were found by name are checked; others were chosen
/// by this similarity.
std::string NodeCompare::more_like(std::size_t node) const {
  // Limits for correlations. Exchanged nodes are reported; merely similar bones are not.
  constexpr double clearly = 0.1, sure = 0.8;
  if (!named_[node] || !group_.content.angular_velocity) return "";
  const double own = alike(node, node);
  for (std::size_t other = 0; other < named_.size(); ++other) {
    if (other == node || !named_[other]) continue;
    const double there = alike(node, other);
    if (there > sure && there > own + clearly) {
      return skeleton_.joint_names[candidates_[other].turns];
    }
  }
  return "";
}

namespace {

/// Fits the rotation from the bone's vectors to the node's. `of_node(row)` and `of_bone(row)`
/// return the vectors; rows that are not `known` get zeros. The first pass over the rows computes
/// the rotation, the second the remaining differences. The bone's vectors are stored after
/// rotation, so that a page can draw both curves together.
template <class Rows, class Known, class OfNode, class OfBone>
SignalFit fit_signal(const Rows& rows, Known known, OfNode of_node, OfBone of_bone) {
  SignalFit out;
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  for (const auto& row : rows) {
    if (known(row)) cross += of_node(row) * of_bone(row).transpose();
  }
  const Quat turn = best_rotation(cross);
  Correlation alike;
  double squares = 0.0;
  for (const auto& row : rows) {
    const Vec3 node = known(row) ? of_node(row) : Vec3::Zero();
    const Vec3 bone = known(row) ? Vec3(turn * of_bone(row)) : Vec3::Zero();
    put_vector(out.node, node);
    put_vector(out.bone, bone);
    if (!known(row)) continue;
    alike.add(node.norm(), bone.norm());
    squares += (node - bone).squaredNorm();
  }
  out.correlation = alike.value();
  out.rms = alike.n > 0.0 ? std::sqrt(squares / alike.n) : 0.0;
  return out;
}

/// Returns the magnitude of vector k of `vectors` [K,3].
double length_at(const std::vector<float>& vectors, std::size_t k) {
  const std::size_t i = 3 * k;
  return std::hypot(static_cast<double>(vectors[i]), static_cast<double>(vectors[i + 1]),
                    static_cast<double>(vectors[i + 2]));
}

/// Returns the time shift of `node` relative to `bone` at which their magnitudes agree best. A
/// parabola through the best shift and its neighbours refines the result. Absent if rows are too
/// far apart.
std::optional<double> lag_of(const SignalFit& signal, const std::vector<std::uint8_t>& known,
                             double step_s) {
  // With fewer than three shifts on each side, or a short take, the best shift would be arbitrary.
  const auto most = static_cast<std::ptrdiff_t>(std::floor(most_lag_s / step_s));
  const auto rows = static_cast<std::ptrdiff_t>(known.size());
  if (most < 3 || rows < 4 * most) return std::nullopt;
  std::vector<double> alike;
  for (std::ptrdiff_t lag = -most; lag <= most; ++lag) {
    Correlation sums;
    for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(0, -lag);
         k < rows - std::max<std::ptrdiff_t>(0, lag); ++k) {
      const auto bone = static_cast<std::size_t>(k), node = static_cast<std::size_t>(k + lag);
      if (known[bone] == 0 || known[node] == 0) continue;
      sums.add(length_at(signal.node, node), length_at(signal.bone, bone));
    }
    alike.push_back(sums.value());
  }
  const auto best = std::max_element(alike.begin(), alike.end());
  // If the peak is at the edge, the true peak may be outside. A weak peak may be random.
  if (best == alike.begin() || best + 1 == alike.end() || *best < 0.5) return std::nullopt;
  const double left = *(best - 1), right = *(best + 1), bend = left - 2.0 * *best + right;
  const double shift = bend < 0.0 ? 0.5 * (left - right) / bend : 0.0;
  return (static_cast<double>(best - alike.begin() - most) + shift) * step_s;
}

}  // namespace

/// Compares angular velocities, and computes the lag from them.
void NodeCompare::compare_rate(const Pair& pair, double kept_step_s, NodeFigures& out) const {
  SignalFit fit = fit_signal(
      kept_, [&pair](const Kept& row) { return is_known(row, pair); },
      [&pair](const Kept& row) -> const Vec3& { return row.nodes[pair.node].rate; },
      [&pair](const Kept& row) -> const Vec3& { return row.bones[pair.candidate].rate; });
  out.has_rate = true;
  out.rate_rms = fit.rms;
  out.rate_correlation = fit.correlation;
  out.lag_s = lag_of(fit, out.valid, kept_step_s);
  out.rate = std::move(fit.node);
  out.mocap_rate = std::move(fit.bone);
}

/// Compares accelerations. If the node measures gravity, gravity is added to the bone's
/// acceleration.
void NodeCompare::compare_acceleration(const Pair& pair, NodeFigures& out) const {
  const Vec3 up(0.0, group_.content.gravity ? standard_gravity : 0.0, 0.0);
  SignalFit fit = fit_signal(
      kept_, [&pair](const Kept& row) { return is_known(row, pair); },
      [&pair](const Kept& row) -> const Vec3& { return row.nodes[pair.node].acceleration; },
      [&pair, &up](const Kept& row) -> Vec3 {
        const BoneReading& bone = row.bones[pair.candidate];
        return bone.acceleration + bone.rotation.conjugate() * up;
      });
  out.has_acceleration = true;
  out.acceleration_rms = fit.rms;
  out.acceleration_correlation = fit.correlation;
  out.acceleration = std::move(fit.node);
  out.mocap_acceleration = std::move(fit.bone);
}

/// Compares orientations after the best constant rotations of world and sensor. Mounting and
/// heading are unknown, so both are fitted; the remaining error is drift and slip.
void NodeCompare::compare_orientation(const Pair& pair, NodeFigures& out) const {
  std::vector<OrientationPair> pairs;
  for (const Kept& row : kept_) {
    if (!is_known(row, pair)) continue;
    pairs.push_back({row.nodes[pair.node].orientation, row.bones[pair.candidate].rotation});
  }
  const OrientationFit fit = fit_orientation(std::move(pairs));
  double squares = 0.0;
  for (const Kept& row : kept_) {
    const Quat& q = row.nodes[pair.node].orientation;
    double off = 0.0;
    if (is_known(row, pair)) {
      off = fit.predicted(row.bones[pair.candidate].rotation).angularDistance(q);
    }
    squares += off * off;
    out.orientation_error.push_back(static_cast<float>(off));
    // The axes of the node in the take's space, for the player. The node's own world has another
    // heading.
    const Quat axes = fit.world.conjugate() * q;
    for (const double x : {axes.w(), axes.x(), axes.y(), axes.z()}) {
      out.axes.push_back(static_cast<float>(x));
    }
  }
  out.has_orientation = true;
  out.orientation_rms = std::sqrt(squares / static_cast<double>(out.rows));
}

/// Compares a node with its bone. With too few rows there is no comparison. `valid` is set first,
/// because the lag in compare_rate() needs it.
NodeFigures NodeCompare::compare(std::size_t node, double kept_step_s) const {
  const Pair pair{node, candidate_of(node)};
  NodeFigures out;
  out.node = group_.node_names[node];
  out.joint = skeleton_.joint_names[candidates_[pair.candidate].turns];
  out.joint_by_name = named_[node].has_value();
  out.more_like = more_like(node);
  out.has_gravity = group_.content.gravity;
  for (const Kept& row : kept_) {
    out.valid.push_back(is_known(row, pair) ? 1 : 0);
    out.rows += out.valid.back();
  }
  // Names and the number of rows are always stated.
  if (out.rows < fewest_rows) return out;
  if (group_.content.angular_velocity) compare_rate(pair, kept_step_s, out);
  if (group_.content.acceleration) compare_acceleration(pair, out);
  if (group_.content.orientation) compare_orientation(pair, out);
  return out;
}

std::vector<NodeFigures> NodeCompare::finish(double kept_step_s) {
  while (next_ < waiting_.size()) settle_next();
  std::vector<NodeFigures> out;
  for (std::size_t s = 0; s < group_.node_names.size(); ++s) out.push_back(compare(s, kept_step_s));
  return out;
}

}  // namespace kinalign
