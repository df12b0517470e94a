// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/benchmark/compared_motion.h"

#include "apps/kinalign/learn/fused_input.h"
#include "apps/kinalign/learn/worn_nodes.h"
#include "apps/kinalign/text/describe_file.h"

#include "kinalign/formats/take/guarded.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/models/body_frame.h"
#include "kinalign/models/denoise_features.h"
#include "kinalign/models/even_grid.h"
#include "kinalign/models/joint_names.h"
#include "kinalign/motion/kinematics.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

namespace kinalign {

// The structure is converted to JSON and back, because a child process returns it as text.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ComparedMotion, take, rate_hz, frames, truth, answers, states,
                                   hidden)

namespace {

// Nose and crown show in which direction the head looks, which the position of its joint does not.
// A Kinect has no such joints.
constexpr float nose_m = 0.14F, crown_m = 0.16F;  // distances from the head's joint
// The time for which a limb is hidden, and the pause between two limbs.
constexpr double hidden_s = 3.0;
/// Samples of a Kinect that are further apart are not interpolated.
constexpr double kinect_gap_s = 0.2;
constexpr const char* true_group = "mocap";

/// The index of each compared joint in a skeleton. Joints are found by the names of a Kinect, or by
/// the names of CMU's skeletons, which the bodies of models have.
Result<std::array<std::size_t, compared_joints>> joints_among(
    const std::vector<std::string>& names) {
  const auto as_kinect = kinect_names(names);
  std::array<std::size_t, compared_joints> out{};
  for (std::size_t p = 0; p < compared_joints; ++p) {
    const std::string wanted(compared_places[p]);
    auto at = index_of(as_kinect, wanted);
    // fuse_joints lists for each joint of a Kinect the corresponding joint of a body.
    for (const FuseJoint& joint : fuse_joints) {
      if (!at && joint.kinect == wanted) at = index_of(names, std::string(joint.body));
    }
    if (!at) return Failure(Error{"", 0, "a skeleton with the joint " + wanted, "no such joint"});
    out[p] = *at;
  }
  return out;
}

/// The rotation of a joint against the world.
Eigen::Quaternionf turned_in_world(const Clip& clip, std::size_t t, std::size_t joint) {
  // The loop goes from the joint to the root and multiplies the rotation of each parent from the
  // left.
  Eigen::Quaternionf out = Eigen::Quaternionf::Identity();
  for (int j = static_cast<int>(joint); j >= 0;
       j = clip.skeleton.parents[static_cast<std::size_t>(j)]) {
    const std::size_t at = t * clip.skeleton.joints() + static_cast<std::size_t>(j);
    out = quat(clip.frames.local_rotations, at).cast<float>() * out;
  }
  return out;
}

/// The positions of the compared points in all frames, in the world's coordinates.
using WorldPlaces = std::vector<float>;  // [frame, point, 3] m

/// The positions of the compared points of a clip. Forward kinematics gives the joints. Nose and
/// crown are at fixed distances from the head's joint and follow the head's rotation.
Result<WorldPlaces> places_of(const Clip& clip) {
  const auto joints = KA_TRY(joints_among(clip.skeleton.joint_names));
  const std::size_t count = clip.skeleton.joints(), frames = clip.frames.size();
  std::vector<double> global(frames * count * 3);
  forward_kinematics(clip.skeleton, clip.frames, global);
  WorldPlaces out;
  out.reserve(frames * compared_count * 3);
  for (std::size_t t = 0; t < frames; ++t) {
    for (const std::size_t j : joints) {
      for (std::size_t k = 0; k < 3; ++k) {
        out.push_back(static_cast<float>(global[3 * (t * count + j) + k]));
      }
    }
    const std::size_t head = joints[2];
    const Eigen::Vector3f base(&out[3 * (t * compared_count + 2)]);
    const Eigen::Quaternionf turn = turned_in_world(clip, t, head);
    // In the head's own axes z points ahead and y up.
    for (const Eigen::Vector3f& way :
         {Eigen::Vector3f(0.0F, 0.0F, nose_m), Eigen::Vector3f(0.0F, crown_m, 0.0F)}) {
      const Eigen::Vector3f place = base + turn * way;
      out.insert(out.end(), place.data(), place.data() + 3);
    }
  }
  return out;
}

/// Makes the positions relative to the middle of the hips, with x to the body's left.
BodyPlaces in_body(WorldPlaces places) {
  // Points 9 and 12 are the hips, 3 and 6 the shoulders. Both pairs together show where the body's
  // left is.
  const BodyJoints joints{{9, 12}, {{9, 12}, {3, 6}}};
  const std::size_t cells = places.size() / 3;
  // The state 2 means "tracked". All points exist in each frame, so each frame has a direction.
  const JointFrames body{compared_count, places, std::vector<std::uint8_t>(cells, std::uint8_t{2})};
  to_body(body_frames(joints, body), places);
  return places;
}

/// The truth of a take: its skeleton "mocap" as it was recorded. The function runs in a child
/// process.
Result<Clip> true_clip(FileSystem& files, const std::string& path) {
  Take take = KA_TRY(read_take(files, path));
  const auto& groups = take.header.groups;
  const auto wanted = std::find_if(groups.begin(), groups.end(), [](const TakeGroup& group) {
    return group.name == true_group && std::holds_alternative<ClipGroup>(group.kind);
  });
  if (wanted == groups.end())
    return Failure(Error{path, 0, "a skeleton \"mocap\"", "no such skeleton"});
  auto& rows = std::get<ClipRows>(take.all.rows[static_cast<std::size_t>(wanted - groups.begin())]);
  Clip out{std::get<ClipGroup>(wanted->kind).skeleton,
           {std::move(take.all.stamps), std::move(rows.local_positions),
            std::move(rows.local_rotations)}};
  if (out.frames.size() > 1) return out;
  return Failure(Error{path, 0, "a skeleton with at least two frames", "fewer frames"});
}

/// For each frame of a model, the row of the truth with the nearest stamp. A model answers at its
/// own frame rate; the truth has the stamps of its device. Both kinds of stamps rise, so one pass
/// over the rows is enough.
std::vector<std::size_t> nearest_rows(const std::vector<Time>& stamps, const EvenSpan& span,
                                      double rate_hz) {
  std::vector<std::size_t> out;
  std::size_t row = 0;
  for (std::size_t t = 0; t < span.frames; ++t) {
    const auto since = std::chrono::duration_cast<Duration>(
        std::chrono::duration<double>(static_cast<double>(t) / rate_hz));
    const Time wanted = span.start + since;
    const auto off = [&](std::size_t i) { return std::abs((stamps[i] - wanted).count()); };
    // If two rows are equally near, the later one is taken. `row` never decreases, since the wanted
    // stamps rise.
    while (row + 1 < stamps.size() && off(row + 1) <= off(row)) ++row;
    out.push_back(row);
  }
  return out;
}

/// The chosen rows of an array of `width` columns.
std::vector<float> rows_of(const std::vector<float>& values, std::size_t width,
                           const std::vector<std::size_t>& rows) {
  std::vector<float> out;
  for (const std::size_t row : rows) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(row * width);
    out.insert(out.end(), first, first + static_cast<std::ptrdiff_t>(width));
  }
  return out;
}

/// The truth at a model's frames: the compared points, and the rotation of the head against the
/// world.
struct TrueFrames {
  WorldPlaces places;                    // [frame, point, 3] m
  std::vector<Eigen::Quaternionf> head;  // for each frame
};

Result<TrueFrames> true_frames(const Clip& clip, const EvenSpan& span, double rate_hz) {
  const auto rows = nearest_rows(clip.frames.stamps, span, rate_hz);
  const auto joints = KA_TRY(joints_among(clip.skeleton.joint_names));
  TrueFrames out;
  out.places = rows_of(KA_TRY(places_of(clip)), 3 * compared_count, rows);
  for (const std::size_t row : rows) out.head.push_back(turned_in_world(clip, row, joints[2]));
  return out;
}

/// The heading of a body, rad: the angle of its left side about the vertical axis.
double heading_of(const BodyFrame& frame) {
  return static_cast<double>(std::atan2(-frame.sine, frame.cosine));
}

/// The mean difference between the headings of the truth and of an answer, rad. The coordinates of
/// the nodes have an arbitrary heading, so this difference is removed later. The mean is taken over
/// sine and cosine, since angles jump by a full turn.
float turned_against(const WorldPlaces& truth, const WorldPlaces& answer) {
  const BodyJoints joints{{9, 12}, {{9, 12}, {3, 6}}};
  const auto frames = [&](const WorldPlaces& places) {
    return body_frames(joints, {compared_count, places,
                                std::vector<std::uint8_t>(places.size() / 3, std::uint8_t{2})});
  };
  const auto a = frames(truth), b = frames(answer);
  double sine = 0.0, cosine = 0.0;
  for (std::size_t t = 0; t < std::min(a.size(), b.size()); ++t) {
    const double apart = heading_of(a[t]) - heading_of(b[t]);
    sine += std::sin(apart);
    cosine += std::cos(apart);
  }
  return static_cast<float>(std::atan2(sine, cosine));
}

/// Adds to `nodes` a simulated node on the head, as node `n`. Its orientation, acceleration and
/// angular velocity are computed from the truth, without the errors of a sensor; the page says so.
/// `yaw` is the heading of the truth's coordinates relative to those of the nodes.
void put_head_node(const TrueFrames& truth, float yaw, double rate_hz, std::size_t n,
                   NodeFrames& nodes) {
  // The rotation by -yaw leads from the truth's coordinates to those of the nodes.
  const Eigen::Quaternionf turn(Eigen::AngleAxisf(-yaw, Eigen::Vector3f::UnitY()));
  const std::size_t frames = nodes.frames();
  const auto rate = static_cast<float>(rate_hz);
  const auto place = [&](std::size_t t) {
    return Eigen::Vector3f(&truth.places[3 * (std::min(t, frames - 1) * compared_count + 2)]);
  };
  for (std::size_t t = 0; t < frames; ++t) {
    const std::size_t before = t == 0 ? 0 : t - 1, after = std::min(t + 1, frames - 1);
    const Eigen::Quaternionf now = turn * truth.head[t];
    // The acceleration is a second difference over two frames to each side (67 ms at 30 Hz), as in
    // the training of models.
    const std::size_t early = t < 2 ? 0 : t - 2, late = std::min(t + 2, frames - 1);
    Eigen::Vector3f acceleration = Eigen::Vector3f::Zero();
    // Within two frames of either end the acceleration is set to zero.
    if (late - early == 4) {
      acceleration = turn * (place(late) - 2.0F * place(t) + place(early)) * (rate * rate / 4.0F);
    }
    // The angular velocity is computed from the frame before to the frame after, so it has no
    // delay.
    const Eigen::AngleAxisf step(truth.head[before].conjugate() * truth.head[after]);
    float angle = step.angle();
    // The head turns by less than half a turn in this time, so the smaller of both angles is right.
    if (angle > static_cast<float>(EIGEN_PI)) angle -= static_cast<float>(2.0 * EIGEN_PI);
    const float span = static_cast<float>(std::max<std::size_t>(after - before, 1)) / rate;
    const Eigen::Vector3f angular = step.axis() * (angle / span);
    const std::size_t at = t * nodes.nodes + n;
    const std::array<float, 4> orientation{now.w(), now.x(), now.y(), now.z()};
    std::copy(orientation.begin(), orientation.end(),
              nodes.orientation.begin() + static_cast<std::ptrdiff_t>(4 * at));
    std::copy(acceleration.data(), acceleration.data() + 3,
              nodes.acceleration.begin() + static_cast<std::ptrdiff_t>(3 * at));
    std::copy(angular.data(), angular.data() + 3,
              nodes.angular_velocity.begin() + static_cast<std::ptrdiff_t>(3 * at));
    // The simulated node has a sample in every frame.
    nodes.valid[at] = 1;
  }
}

/// Runs `work` in a child process, so that a crash of HDF5 on one take does not end the run. Errors
/// that name no file get the name of the take.
Result<ComparedMotion> guarded(const ComparedTake& take,
                               const std::function<Result<ComparedMotion>()>& work) {
  const auto in_child = [&]() -> Result<std::string> {
    // The JSON has enough digits for floats to be read back unchanged.
    return nlohmann::json(KA_TRY(work().map_error(in_file(take.path)))).dump();
  };
  const std::string text = KA_TRY(run_guarded(GuardLimits{}, blame(take.path), in_child));
  try {
    return nlohmann::json::parse(text).get<ComparedMotion>();
  } catch (const nlohmann::json::exception&) {
    // JSON writes NaN and infinity as null, so such an answer of a model can't be read here.
    return Failure(Error{take.path, 0, "models with finite answers", "NaN or infinite values"});
  }
}

/// The nodes of a take at the model's frames, calibrated for this model. `worn` states where the
/// T-pose is and how headings are found ("auto").
Result<NodeFrames> nodes_for(const PoseModel& model, const NamedNodes& named, const WornWords& worn,
                             const EvenSpan& span) {
  const PosedNodes posed =
      KA_TRY(calibrated_nodes(model.layout, model.body.skeleton, named, worn, span));
  return on_bones(posed.calibration, posed.even.worn);
}

/// The answers of all models to the nodes of a take. A first answer without the head's node shows
/// the heading of the nodes' coordinates.
Result<ComparedMotion> poses_of(std::vector<PoseSolver>& solvers, const ComparedTake& take,
                                FileSystem& files) {
  // The frames begin with the truth's first frame and have the rate of the models, so the truth and
  // all answers have the same frames.
  const Clip clip = KA_TRY(true_clip(files, take.path));
  const NamedNodes named = KA_TRY(nodes_of_take(files, take.path, {}));
  const double rate_hz = solvers.front().model().layout.rate_hz;
  const EvenSpan span = span_of(clip.frames.stamps.front(), clip.frames.stamps.back(), rate_hz);
  const TrueFrames truth = KA_TRY(true_frames(clip, span, rate_hz));
  ComparedMotion out{take.name, rate_hz, span.frames, in_body(truth.places), {}, {}, {}};
  for (PoseSolver& solver : solvers) {
    const PoseLayout& layout = solver.model().layout;
    if (layout.rate_hz != rate_hz) {
      return Failure(Error{"", 0, "models with the same rate", "several rates"});
    }
    // No take has a node on the head; put_head_node() simulates it below.
    NodeFrames nodes = KA_TRY(nodes_for(solver.model(), named, {"", "auto"}, span));
    const auto head = std::find(layout.nodes.begin(), layout.nodes.end(), "head");
    // The first answer uses only the real nodes. It shows by how much the nodes' coordinates are
    // turned.
    WorldPlaces places = KA_TRY(places_of(solver.clip(nodes, span.start)));
    if (head != layout.nodes.end()) {
      const float yaw = turned_against(truth.places, places);
      put_head_node(truth, yaw, rate_hz, static_cast<std::size_t>(head - layout.nodes.begin()),
                    nodes);
      places = KA_TRY(places_of(solver.clip(nodes, span.start)));
    }
    // in_body() removes position and heading of the body. Nodes can't measure them without a
    // camera, so they are not compared.
    out.answers.push_back(in_body(std::move(places)));
  }
  return out;
}

/// The limbs that are hidden one after the other, by the names of a Kinect's joints. The page's
/// caption states the same order, beginning with the right arm.
const std::array<std::vector<std::string>, 4>& hidden_limbs() {
  static const std::array<std::vector<std::string>, 4> all{
      {{"ElbowRight", "WristRight", "HandRight"},
       {"ElbowLeft", "WristLeft", "HandLeft"},
       {"KneeRight", "AnkleRight", "FootRight"},
       {"KneeLeft", "AnkleLeft", "FootLeft"}}};
  return all;
}

/// The limb that is hidden in frame `t`. Empty if no limb is hidden then.
std::optional<std::size_t> hidden_limb_at(std::size_t t, double rate_hz) {
  // For 3 s no limb is hidden, then for 3 s the right arm, for 3 s none, then the left arm, and so
  // on.
  const auto stretch = static_cast<std::size_t>(static_cast<double>(t) / rate_hz / hidden_s);
  if (stretch % 2 == 0) return std::nullopt;
  return (stretch / 2) % hidden_limbs().size();
}

bool is_hidden(std::size_t t, double rate_hz, const std::string& joint) {
  const auto limb = hidden_limb_at(t, rate_hz);
  if (!limb) return false;
  const auto& joints = hidden_limbs()[*limb];
  return std::find(joints.begin(), joints.end(), joint) != joints.end();
}

/// Hides limbs from the Kinect: their joints become missing.
void hide_limbs(const std::vector<std::string>& joints, double rate_hz, JointFrames& kinect) {
  for (std::size_t t = 0; t < kinect.frames(); ++t) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (!is_hidden(t, rate_hz, joints[j])) continue;
      const std::size_t at = t * joints.size() + j;
      // A hidden joint is like one that the Kinect has lost: its state is 0 and its position zero.
      kinect.seen[at] = 0;
      std::fill_n(kinect.positions.begin() + static_cast<std::ptrdiff_t>(3 * at), 3, 0.0F);
    }
  }
}

/// Adds the Kinect's own joints as an answer, with which figure 10 compares the others. A missing
/// joint stays at its last position. `out.states` lets the picture leave out missing joints.
void put_kinect(const FuseLayout& layout, JointFrames kinect, ComparedMotion& out) {
  const JointFrames seen = kinect;
  fill_missing(kinect, true);
  WorldPlaces places;
  for (std::size_t t = 0; t < kinect.frames(); ++t) {
    for (std::size_t p = 0; p < compared_count; ++p) {
      // A Kinect has no nose and crown. The position of another joint stands in their place, and
      // the state 0 marks it as missing.
      const auto j = index_of(layout.joints, std::string(compared_places[p]));
      const std::size_t at = t * kinect.joints + j.value_or(0);
      places.insert(places.end(), &kinect.positions[3 * at], &kinect.positions[3 * at] + 3);
      out.states.push_back(j ? seen.seen[at] : std::uint8_t{0});
    }
  }
  out.answers.push_back(in_body(std::move(places)));
}

/// The answers of one model to the Kinect alone, to the nodes alone and to both. Nodes do not
/// measure the lengths of bones, so their answer has the model's mean body.
Result<ComparedMotion> devices_of(Fuser& fuser, const ComparedTake& take, FileSystem& files) {
  const FuseLayout& layout = fuser.model().layout;
  const double rate_hz = layout.nodes.rate_hz;
  const Clip clip = KA_TRY(true_clip(files, take.path));
  BothDevices both;
  both.kinect = KA_TRY(points_of_take(files, take.path, {}));
  both.nodes = KA_TRY(nodes_of_take(files, take.path, {}));
  // The nodes are calibrated with the whole Kinect; limbs are hidden afterwards.
  FusedInput given = KA_TRY(fused_input(fuser.model(), std::move(both), {"", "auto"}));
  hide_limbs(layout.joints, rate_hz, given.input.kinect);
  const EvenSpan span{given.start, given.input.frames()};
  ComparedMotion out{take.name, rate_hz, span.frames, {}, {}, {}, {}};
  out.truth = in_body(KA_TRY(true_frames(clip, span, rate_hz)).places);
  put_kinect(layout, given.input.kinect, out);
  // The model gets all three inputs in the same form: the samples of an unused device are marked as
  // invalid.
  FuseInput kinect_alone = given.input, nodes_alone = given.input;
  std::fill(kinect_alone.nodes.valid.begin(), kinect_alone.nodes.valid.end(), std::uint8_t{0});
  std::fill(nodes_alone.kinect.seen.begin(), nodes_alone.kinect.seen.end(), std::uint8_t{0});
  const Skeleton mean = fuser.model().body.skeleton;
  for (const FuseInput* input : {&kinect_alone, &nodes_alone, &given.input}) {
    // Only the Kinect measures the lengths of bones, so an answer without it must not use them.
    fuser.use_body(input == &nodes_alone ? mean : given.body);
    out.answers.push_back(in_body(KA_TRY(places_of(fuser.clip(*input, given.start)))));
  }
  for (std::size_t t = 0; t < span.frames; ++t) {
    for (const std::string_view place : compared_places) {
      // `hidden` has an element for each point, although only the joints of limbs are hidden.
      out.hidden.push_back(is_hidden(t, rate_hz, std::string(place)) ? 1 : 0);
    }
  }
  return out;
}

}  // namespace

Result<ComparedMotion> compare_poses(std::vector<PoseSolver>& solvers, const ComparedTake& take,
                                     Call& call) {
  return guarded(take, [&] { return poses_of(solvers, take, call.surroundings.files); });
}

Result<ComparedMotion> compare_devices(Fuser& fuser, const ComparedTake& take, Call& call) {
  return guarded(take, [&] { return devices_of(fuser, take, call.surroundings.files); });
}

}  // namespace kinalign
