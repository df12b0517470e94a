// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/benchmark/pose_table.h"

#include "kinalign/models/body_frame.h"
#include "kinalign/models/joint_names.h"
#include "kinalign/motion/kinect_joints.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace kinalign {

namespace {

/// Each point of the error curve is the mean over this time.
constexpr float bin_s = 0.5F;
/// The moving bodies show at most this much of a take.
constexpr double most_moving_s = 30.0;
// Speeds are computed from positions this much before and after a frame.
constexpr double half_turn_window_s = 0.25;

/// The joints that show what a person does.
struct ActingJoints {
  std::size_t wrist_left = 0, wrist_right = 0;
  std::array<std::size_t, 2> hips{}, shoulders{};
  std::vector<std::size_t> all;  // all joints that a Kinect and the truth share
};

/// Finds these joints. Empty if one of the six is missing; then no moment can be chosen, and the
/// page says why.
std::optional<ActingJoints> acting_joints(const std::vector<std::string>& outputs) {
  const auto names = kinect_names(outputs);
  std::array<std::size_t, 6> found{};
  const std::array<const char*, 6> wanted{"WristLeft", "WristRight",   "HipLeft",
                                          "HipRight",  "ShoulderLeft", "ShoulderRight"};
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto at = index_of(names, wanted[i]);
    if (!at) return std::nullopt;
    found[i] = *at;
  }
  ActingJoints out{found[0], found[1], {found[2], found[3]}, {found[4], found[5]}, {}};
  for (const auto& place : shared_joints_there(names)) {
    if (place) out.all.push_back(*place);
  }
  return out;
}

/// The truth of one stretch, with the quantities by which moments are chosen. Only frames for which
/// is_whole() is true may be chosen. The arguments must live longer than this object.
class TrueMotion {
 public:
  TrueMotion(const CleaningData& data, const ActingJoints& joints, const Pair& pair)
      : pair_(pair),
        joints_(joints),
        count_(data.layout.outputs.size()),
        rate_hz_(data.layout.rate_hz) {
    // The state 2 means "tracked", so every joint counts for the direction of the body.
    JointFrames body{count_, pair.truth,
                     std::vector<std::uint8_t>(pair.valid.size(), std::uint8_t{2})};
    // A body without hips and shoulders has no direction, so turning() always returns 0.
    if (const auto found = body_joints(data.layout.outputs)) frames_ = body_frames(*found, body);
  }

  std::size_t frames() const { return pair_.input.frames(); }
  // True if all shared joints are valid in frame `t`.
  bool is_whole(std::size_t t) const {
    return std::all_of(joints_.all.begin(), joints_.all.end(),
                       [&](std::size_t j) { return pair_.valid[t * count_ + j] != 0; });
  }
  const float* place(std::size_t t, std::size_t joint) const {
    return &pair_.truth[3 * (t * count_ + joint)];
  }
  // The mean height of two joints, m.
  double height(std::size_t t, const std::array<std::size_t, 2>& both) const {
    return 0.5 * static_cast<double>(place(t, both[0])[1] + place(t, both[1])[1]);
  }
  /// The mean speed of the joints, m/s, between a quarter of a second before and after the frame.
  double speed(std::size_t t) const {
    const std::size_t a = earlier(t), b = later(t);
    double sum = 0.0;
    for (const std::size_t j : joints_.all) {
      const float *from = place(a, j), *to = place(b, j);
      sum += static_cast<double>(std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]));
    }
    return sum / static_cast<double>(joints_.all.size()) / seconds(a, b);
  }
  /// The turning speed of the body, rad/s. A turn to the person's left is positive.
  double turning(std::size_t t) const {
    if (frames_.empty()) return 0.0;
    const std::size_t a = earlier(t), b = later(t);
    const double turned = heading(b) - heading(a);
    // Headings jump by a full turn; the remainder gives the smaller of both possible angles.
    return std::remainder(turned, 2.0 * std::numbers::pi) / seconds(a, b);
  }

 private:
  std::size_t window() const {
    return std::max<std::size_t>(static_cast<std::size_t>(half_turn_window_s * rate_hz_), 1);
  }
  // At the ends of the stretch the time is shorter; seconds() returns the real time.
  std::size_t earlier(std::size_t t) const { return t < window() ? 0 : t - window(); }
  std::size_t later(std::size_t t) const { return std::min(t + window(), frames() - 1); }
  double seconds(std::size_t a, std::size_t b) const {
    return static_cast<double>(std::max<std::size_t>(b - a, 1)) / rate_hz_;
  }
  /// The heading of the body in frame `t`, rad: the angle of the direction to its left, (cosine, 0,
  /// sine). The angle is 0 at +x. Seen from above, a turn to the left leads from +x to -z.
  double heading(std::size_t t) const {
    return static_cast<double>(std::atan2(-frames_[t].sine, frames_[t].cosine));
  }

  const Pair& pair_;
  const ActingJoints& joints_;
  std::size_t count_;
  double rate_hz_;
  std::vector<BodyFrame> frames_;
};

/// A column of table 8. It shows the frame in which `score` is highest.
struct PoseSearch {
  const char* name;
  std::function<double(const TrueMotion&, const ActingJoints&, std::size_t)> score;
};

/// The five kinds of moments. Each score is highest in the frame that shows the pose most clearly.
std::vector<PoseSearch> pose_searches() {
  using Motion = const TrueMotion&;
  using Joints = const ActingJoints&;
  // The height of the shoulders above the hips is largest for an upright trunk and smallest for a
  // bent one.
  const auto trunk = [](Motion m, Joints j, std::size_t t) {
    return m.height(t, j.shoulders) - m.height(t, j.hips);
  };
  // The axis y points up, so the second coordinate is the height.
  const auto hands = [](Motion m, Joints j, std::size_t t) {
    return std::array{static_cast<double>(m.place(t, j.wrist_left)[1]),
                      static_cast<double>(m.place(t, j.wrist_right)[1])};
  };
  // Only scores of the same kind are compared, so their units may differ.
  return {{"standing",
           [=](Motion m, Joints j, std::size_t t) {
             const auto [left, right] = hands(m, j, t);
             const double raised = std::max(left, right) - m.height(t, j.hips);
             return trunk(m, j, t) - std::max(raised, 0.0) - m.speed(t);
           }},
          {"waving",
           [=](Motion m, Joints j, std::size_t t) {
             const auto [left, right] = hands(m, j, t);
             return std::abs(left - right);
           }},
          {"bending", [=](Motion m, Joints j, std::size_t t) { return -trunk(m, j, t); }},
          {"turning right", [](Motion m, Joints, std::size_t t) { return -m.turning(t); }},
          {"turning left", [](Motion m, Joints, std::size_t t) { return m.turning(t); }}};
}

struct ChosenFrame {
  std::size_t pair = 0, frame = 0;  // index in data.tested, and frame
  double score = -std::numeric_limits<double>::infinity();
};

/// The best frame for each kind of moment. The first and last half second of a stretch are left
/// out.
std::vector<ChosenFrame> choose_frames(const CleaningData& data, const ActingJoints& joints,
                                       const std::vector<PoseSearch>& searches) {
  std::vector<ChosenFrame> out(searches.size());
  // Half a second is longer than the time that speed() and turning() need before and after a frame.
  const auto edge = static_cast<std::size_t>(0.5 * data.layout.rate_hz);
  for (std::size_t p = 0; p < data.tested.size(); ++p) {
    const TrueMotion motion(data, joints, *data.tested[p]);
    for (std::size_t t = edge; t + edge < motion.frames(); ++t) {
      if (!motion.is_whole(t)) continue;
      for (std::size_t s = 0; s < searches.size(); ++s) {
        const double score = searches[s].score(motion, joints, t);
        // If frames have the same score, the first is taken, so that the choice is always the same.
        if (score > out[s].score) out[s] = {p, t, score};
      }
    }
  }
  return out;
}

/// The origin of a picture: below the true hips, at the height of the truth's lowest joint. The
/// Kinect and all answers are drawn with the same origin, so that errors of position are visible.
std::array<float, 3> origin_of(const CleaningData& data, const ActingJoints& joints,
                               const ChosenFrame& at) {
  const TrueMotion motion(data, joints, *data.tested[at.pair]);
  const float *left = motion.place(at.frame, joints.hips[0]),
              *right = motion.place(at.frame, joints.hips[1]);
  float lowest = std::numeric_limits<float>::max();
  for (const std::size_t j : joints.all) {
    lowest = std::min(lowest, motion.place(at.frame, j)[1]);
  }
  return {0.5F * (left[0] + right[0]), lowest, 0.5F * (left[2] + right[2])};
}

/// Frame `t` of an array [frame, joint, 3], relative to the origin.
StickFigure figure_at(const std::vector<float>& positions, std::size_t t,
                      const std::vector<int>& parents, const std::array<float, 3>& origin,
                      FigureColour colour) {
  StickFigure out{colour, false, {}, parents, {}};
  const std::size_t first = 3 * t * parents.size();
  for (std::size_t i = 0; i < 3 * parents.size(); ++i) {
    // The index i % 3 is the coordinate: x, y or z.
    out.positions.push_back(positions[first + i] - origin[i % 3]);
  }
  return out;
}

/// The body that the Kinect saw. The page draws a joint with state "inferred" dashed.
StickFigure kinect_at(const CleaningData& data, const ChosenFrame& at,
                      const std::array<float, 3>& origin) {
  const JointFrames& input = data.tested[at.pair]->input;
  StickFigure out = figure_at(input.positions, at.frame, kinect_parents_of(data.layout.inputs),
                              origin, FigureColour::kinect);
  const auto first = input.seen.begin() + static_cast<std::ptrdiff_t>(at.frame * input.joints);
  out.states.assign(first, first + static_cast<std::ptrdiff_t>(input.joints));
  return out;
}

/// The second line of a column's heading: person, action and time.
std::string where_of(const CleaningData& data, const ChosenFrame& at) {
  const Pair& pair = *data.tested[at.pair];
  return fmt::format("sub-{} {}, {:.1f} s", pair.subject, pair.action,
                     static_cast<double>(at.frame) / data.layout.rate_hz);
}

/// The index of the longest stretch in data.tested.
std::size_t longest_stretch(const CleaningData& data) {
  std::size_t out = 0;
  for (std::size_t p = 1; p < data.tested.size(); ++p) {
    if (data.tested[p]->input.frames() > data.tested[out]->input.frames()) out = p;
  }
  return out;
}

/// The joints of a body that are drawn: those that a Kinect has, too.
struct DrawnJoints {
  std::vector<std::size_t> joints;  // indices in the body
  std::vector<int> parents;         // indices in `joints`
};

/// Finds the joints that have names of a Kinect, and the parent of each among them.
DrawnJoints drawn_joints(const std::vector<std::string>& names) {
  DrawnJoints out;
  std::vector<std::string> kept;
  const auto called = kinect_names(names);
  // Fingers and other joints that a Kinect does not have are left out, in the truth and in the
  // answers.
  for (std::size_t j = 0; j < called.size(); ++j) {
    if (std::find(kinect_joints.begin(), kinect_joints.end(), called[j]) == kinect_joints.end()) {
      continue;
    }
    out.joints.push_back(j);
    kept.push_back(called[j]);
  }
  out.parents = kinect_parents_of(kept);
  return out;
}

/// Makes a body without a name from the first `frames` frames of an array [frame, joint, 3].
MovingBody moving_body(const DrawnJoints& drawn, const std::vector<float>& positions,
                       std::size_t joints, std::size_t frames) {
  MovingBody out;
  out.parents = drawn.parents;
  for (std::size_t t = 0; t < frames; ++t) {
    for (const std::size_t j : drawn.joints) {
      const float* place = &positions[3 * (t * joints + j)];
      out.positions.insert(out.positions.end(), place, place + 3);
    }
  }
  return out;
}

}  // namespace

PosePictures pose_table(const CleaningData& data, const std::vector<CleanedTakes>& all) {
  PosePictures out;
  out.id = "table-8";
  out.title = "Table 8: instants of the test takes";
  const auto joints = acting_joints(data.layout.outputs);
  if (!joints) {
    out.absent = "The truth has no hips, shoulders or wrists, so no instants can be chosen.";
    return out;
  }
  out.caption =
      "All pictures have the same scale and direction of view. Green: the Kinect, dashed where a "
      "joint is inferred. Red: the truth, pale behind each answer. Colour of the text: the "
      "method's answer, without smoothing. Below: mean distance to the truth. The instants are "
      "chosen by the truth alone, among all test takes: the person stands upright and still, the "
      "hands differ most in height, the trunk is lowest, the body turns fastest to the left and to "
      "the right.";
  const auto searches = pose_searches();
  const auto chosen = choose_frames(data, *joints, searches);
  std::vector<StickFigure> truths;
  std::vector<std::array<float, 3>> origins;
  // The first row shows the input of all methods, the Kinect. The rows of the methods follow, and
  // the last row is the truth.
  out.rows.emplace_back("Kinect", std::vector<PosePicture>{});
  for (std::size_t c = 0; c < chosen.size(); ++c) {
    out.columns.emplace_back(searches[c].name, where_of(data, chosen[c]));
    origins.push_back(origin_of(data, *joints, chosen[c]));
    truths.push_back(figure_at(data.tested[chosen[c].pair]->truth, chosen[c].frame,
                               data.layout.parents, origins[c], FigureColour::truth));
    out.rows.back().second.push_back({{kinect_at(data, chosen[c], origins[c])}, ""});
  }
  for (const CleanedTakes& method : all) {
    out.rows.emplace_back(method.method, std::vector<PosePicture>{});
    for (std::size_t c = 0; c < chosen.size(); ++c) {
      const auto& [p, t, score] = chosen[c];
      StickFigure behind = truths[c];
      behind.is_pale = true;
      // The number below a picture is the error of this method in this frame.
      const float cm = errors_over_time(data, *data.tested[p], method.answers[p])[t];
      out.rows.back().second.push_back(
          {{behind,
            figure_at(method.answers[p], t, data.layout.parents, origins[c], FigureColour::method)},
           fmt::format("{:.1f} cm", cm)});
    }
  }
  out.rows.emplace_back("truth", std::vector<PosePicture>{});
  for (const StickFigure& truth : truths) out.rows.back().second.push_back({{truth}, ""});
  return out;
}

// The last time of less than half a second is left out, since its mean would be noisier than the
// others.
ErrorPlot error_plot(const CleaningData& data, const std::vector<CleanedTakes>& all) {
  const std::size_t longest = longest_stretch(data);
  const Pair& pair = *data.tested[longest];
  ErrorPlot out;
  out.step_s = bin_s;
  out.caption = fmt::format(
      "Mean distance to the truth in {}, the longest test take: means over half a second of the "
      "answers without smoothing.",
      pair.take);
  const auto bin = static_cast<std::size_t>(bin_s * static_cast<float>(data.layout.rate_hz));
  for (const CleanedTakes& method : all) {
    const auto errors = errors_over_time(data, pair, method.answers[longest]);
    ErrorCurve curve{method.method, {}};
    for (std::size_t t = 0; t + bin <= errors.size(); t += bin) {
      float sum = 0.0F;
      for (std::size_t i = t; i < t + bin; ++i) sum += errors[i];
      curve.cm.push_back(sum / static_cast<float>(bin));
    }
    out.curves.push_back(std::move(curve));
  }
  return out;
}

SideBySide side_by_side(const CleaningData& data, const std::vector<CleanedTakes>& all) {
  const std::size_t longest = longest_stretch(data);
  const Pair& pair = *data.tested[longest];
  // The page contains every frame of every body, so its size grows with this time.
  const auto most = static_cast<std::size_t>(most_moving_s * data.layout.rate_hz);
  const std::size_t frames = std::min(pair.input.frames(), most);
  SideBySide out;
  out.rate_hz = data.layout.rate_hz;
  out.caption = fmt::format(
      "{}, the longest test take. Pale red behind each: the truth. Next to a name: mean distance "
      "to the truth at that instant, without smoothing. Drag a picture to turn all of them.",
      pair.take);
  const DrawnJoints answered = drawn_joints(data.layout.outputs),
                    seen = drawn_joints(data.layout.inputs);
  const std::size_t joints = data.layout.outputs.size();
  MovingBody truth = moving_body(answered, pair.truth, joints, frames);
  truth.name = "truth";
  truth.colour = FigureColour::truth;
  out.bodies.push_back(std::move(truth));
  MovingBody kinect = moving_body(seen, pair.input.positions, pair.input.joints, frames);
  kinect.name = "Kinect";
  kinect.colour = FigureColour::kinect;
  // Only the Kinect has states; an answer has a position for every joint.
  for (std::size_t t = 0; t < frames; ++t) {
    for (const std::size_t j : seen.joints) {
      kinect.states.push_back(pair.input.seen[t * pair.input.joints + j]);
    }
  }
  out.bodies.push_back(std::move(kinect));
  for (const CleanedTakes& method : all) {
    const std::vector<float>& answer = method.answers[longest];
    MovingBody body = moving_body(answered, answer, joints, frames);
    body.name = method.method;
    body.cm = errors_over_time(data, pair, answer);
    // The errors are cut to the frames that are shown.
    body.cm.resize(frames);
    out.bodies.push_back(std::move(body));
  }
  return out;
}

}  // namespace kinalign
