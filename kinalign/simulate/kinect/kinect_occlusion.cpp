// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/kinect/kinect_occlusion.h"

#include "kinalign/simulate/kinect/kinect_capsules.h"
#include "kinalign/simulate/kinect/kinect_coloured.h"
#include "kinalign/simulate/kinect/kinect_draws.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr int patience = 2;  // number of frames for which a joint may be hidden before it is marked
constexpr double gives_up = 0.93;  // probability that the tracker guesses the position; otherwise
                                   // the tracker reports the hiding object
constexpr double way_per_frame = 1.0 / 3.0;  // share of the way to the guess
constexpr double guess_tau_s = 0.8;
// Probability that a visible joint is marked for one or two frames, per frame.
constexpr double doubt = 0.003;

// A guess is wrong by an angle, times the length of the bone. The figures are the sd for each axis.
// Fitted to the far side of a body that stands and steps at 90 degrees: the rms of the far arm, the
// far leg and all joints.
struct GuessNoise {
  double at_entry, process;  // rad
};
// Share of the parent's error that is added if the parent is guessed too; fitted to the same data.
constexpr double of_parent = 0.7;
constexpr double longest_bone = 1.0;      // m; a longer distance is not a bone
constexpr double still_limb_share = 0.3;  // a still limb is guessed better

// The guess of a trunk joint has no slow error.
GuessNoise guess_noise(KinectPart part) {
  switch (part) {
    case KinectPart::arm:
      return {0.19, 0.29};
    case KinectPart::leg:
      return {0.18, 0.18};
    case KinectPart::trunk:
      break;
  }
  return {0.1, 0.0};
}

/// The state that the tracker keeps for one joint.
struct Memory {
  int hidden = 0;             // number of consecutive frames in which the joint is hidden
  bool infers = false;        // true: the position is guessed; false: the hiding object is reported
  double away = 0.0;          // share of the way to the guess that is reached
  double back = 1.0;          // share of that way per frame, when the joint is seen again
  int doubted = 0;            // number of further frames that are marked
  Vec3 bone = Vec3::Zero();   // m, from the parent, in the axes of the heading, when last seen
  Vec3 entry = Vec3::Zero();  // random draw at the beginning of a guess, sd 1
  std::array<SmoothNoise, 3> wandering{};  // slow part of the error, sd 1
  Vec3 guess = Vec3::Zero();               // m, camera space, without its error
  Vec3 error = Vec3::Zero();               // m, axes of the heading, error of the guess

  Vec3 wander() const { return {wandering[0].value(), wandering[1].value(), wandering[2].value()}; }
};

/// Processes the joints from the trunk outwards, because the guess of a joint depends on the guess
/// of its parent.
class Tracker {
 public:
  Tracker(const KinectScene& scene, const KinectOptions& options, const KinectIds& ids,
          PointFrames& frames)
      : scene_(scene),
        options_(options),
        random_(kinect_stream(KinectDraw::occlusion, ids)),
        step_(SmoothNoise::per_tau * kinect_frame_s / guess_tau_s),
        frames_(frames) {
    for (const KinectJoint j : kinect_tree_order) {
      if (scene.frames() > 0) remember(0, j, vec3(frames.positions, j));
    }
  }

  /// The true body decides whether a joint is hidden. The positions that are moved contain all
  /// earlier errors.
  void frame(std::size_t t, std::span<const Unseen> unseen) {
    const std::span<const double> truth(&scene_.truth[3 * kinect_joint_count * t],
                                        3 * kinect_joint_count);
    for (const KinectJoint j : kinect_tree_order) {
      std::optional<Vec3> hider;
      if (options_.parts.occlusion) hider = hidden_behind(truth, j, options_.radii);
      const bool below = unseen[t * kinect_joint_count + j] == Unseen::below_image;
      step(t, j, hider, below);
    }
  }

 private:
  /// Draws use the number of the frame, so a dropped frame does not change later draws.
  std::uint64_t counter(std::size_t t, KinectJoint j) const {
    return static_cast<std::uint64_t>(scene_.ticks[t].number) * kinect_joint_count + j;
  }

  /// Processes one joint in one frame. While the joint is hidden, the reported position moves to
  /// the guess. When the joint is seen again, the position moves back.
  void step(std::size_t t, KinectJoint j, const std::optional<Vec3>& hider, bool below) {
    Memory& memory = memories_[j];
    const std::uint64_t k = counter(t, j);
    const Vec3 seen = vec3(frames_.positions, t * kinect_joint_count + j);
    wander(memory, k);
    if (hider || below) {
      if (++memory.hidden == patience + 1) enter(memory, j, k, below);
    } else {
      // The position is back after one, two or three frames.
      if (memory.hidden > patience)
        memory.back = 1.0 / (1.0 + std::floor(3.0 * random_.uniform(k, 1)));
      memory.hidden = 0;
    }
    const bool lost = memory.hidden > patience;
    if (lost) {
      memory.away = std::min(1.0, memory.away + way_per_frame);
    } else {
      memory.away = std::max(0.0, memory.away - memory.back);
    }
    put_guess(t, j, seen, memory.infers || !hider ? std::nullopt : hider);
    mark(t, j, lost && memory.infers, k);
  }

  /// The process also runs while no guess is made, so that it does not begin anew at each guess.
  void wander(Memory& memory, std::uint64_t k) {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto [first, second] = random_.normals(k, 2 + 2 * a);
      step_.run(memory.wandering[a], first, second);
    }
  }

  void enter(Memory& memory, KinectJoint j, std::uint64_t k, bool below) {
    const bool torso = of_torso(j);  // the torso is too large to be mistaken for another object
    memory.infers = below || torso || random_.chance(k, 0, gives_up);
    memory.entry = Vec3(random_.normal(k, 8), random_.normal(k, 10), random_.normal(k, 12));
  }

  /// Stores the joint's position relative to its parent, for a later guess.
  void remember(std::size_t t, KinectJoint j, const Vec3& seen) {
    Memory& memory = memories_[j];
    memory.guess = seen;
    memory.bone =
        scene_.headings[t].axes.transpose() * (seen - memories_[kinect_limbs[j].parent].guess);
  }

  /// Computes the guess: the hiding object, or the parent's guess plus the bone. Both get an error.
  void put_guess(std::size_t t, KinectJoint j, const Vec3& seen, const std::optional<Vec3>& hider) {
    Memory& memory = memories_[j];
    const Memory& parent = memories_[kinect_limbs[j].parent];
    const Eigen::Matrix3d& axes = scene_.headings[t].axes;
    const bool root = kinect_limbs[j].parent == j;
    if (memory.hidden == 0 && memory.away <= 0.0) {
      remember(t, j, seen);
      memory.error.setZero();
      return;
    }
    memory.guess = hider ? *hider : root ? seen : Vec3(parent.guess + axes * memory.bone);
    const GuessNoise size = guess_noise(kinect_limbs[j].part);
    const double length = std::min(memory.bone.norm(), longest_bone);
    const double stir = scene_.stir[t * kinect_joint_count + j];
    const double moved = std::min(1.0, still_limb_share + stir / full_stir);
    memory.error = of_parent * parent.error +
                   length * (size.at_entry * memory.entry + moved * size.process * memory.wander());
    const Vec3 guessed = memory.guess + axes * memory.error;
    vec3(frames_.positions, t * kinect_joint_count + j) =
        (1.0 - memory.away) * seen + memory.away * guessed;
  }

  /// Marks inferred joints, and sometimes a visible joint.
  void mark(std::size_t t, KinectJoint j, bool inferred, std::uint64_t k) {
    Memory& memory = memories_[j];
    if (options_.parts.occlusion && memory.doubted == 0 && random_.chance(k, 14, doubt)) {
      memory.doubted = random_.chance(k, 15, 0.5) ? 2 : 1;
    }
    if (memory.doubted > 0) {
      --memory.doubted;
      inferred = true;
    }
    if (inferred) frames_.state[t * kinect_joint_count + j] = Tracking::inferred;
  }

  const KinectScene& scene_;
  const KinectOptions& options_;
  RandomStream random_;
  SmoothStep step_;
  PointFrames& frames_;
  std::array<Memory, kinect_joint_count> memories_{};
};

}  // namespace

void guess_hidden(const KinectScene& scene, const KinectOptions& options, const KinectIds& ids,
                  std::span<const Unseen> unseen, PointFrames& frames) {
  Tracker tracker(scene, options, ids, frames);
  for (std::size_t t = 0; t < scene.frames(); ++t) tracker.frame(t, unseen);
}

}  // namespace kinalign
