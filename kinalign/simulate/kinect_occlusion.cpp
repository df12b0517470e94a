// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/kinect_occlusion.h"

#include "kinalign/simulate/kinect_capsules.h"
#include "kinalign/simulate/kinect_coloured.h"
#include "kinalign/simulate/kinect_draws.h"
#include "kinalign/simulate/kinect_noise.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr int patience = 2;                  // frames that a joint may be hidden without a word
constexpr double gives_up = 0.93;            // else the tracker follows what hides the joint
constexpr double way_per_frame = 1.0 / 3.0;  // to the guess
constexpr double guess_tau_s = 0.8;
constexpr double doubt = 0.003;  // of a frame of a joint that is seen, for one or two frames

struct GuessNoise {
  double at_entry, process;  // m, sd per axis
};

GuessNoise guess_noise(KinectPart part) {
  switch (part) {
    case KinectPart::arm:
      return {0.05, 0.06};
    case KinectPart::leg:
      return {0.06, 0.06};
    case KinectPart::trunk:
      break;
  }
  return {0.02, 0.0};
}

/// What the tracker remembers of one joint.
struct Memory {
  int hidden = 0;             // frames in a row
  bool infers = false;        // else it follows, once patience is over
  double away = 0.0;          // share of the way to the guess
  double back = 1.0;          // share of that way per frame when the joint is seen again
  int doubted = 0;            // frames that are still to be marked
  Vec3 bone = Vec3::Zero();   // from the parent, heading space, as last seen
  Vec3 entry = Vec3::Zero();  // draw at entry, unit, along the tree
  std::array<SmoothNoise, 3> wandering{};  // unit
  std::array<Vec3, 2> draws{Vec3::Zero(), Vec3::Zero()};
  Vec3 guess = Vec3::Zero();  // m, camera space, without its error

  Vec3 wander() const { return {wandering[0].value, wandering[1].value, wandering[2].value}; }
};

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
  std::uint64_t counter(std::size_t t, KinectJoint j) const {
    return static_cast<std::uint64_t>(scene_.ticks[t].number) * kinect_joint_count + j;
  }

  void step(std::size_t t, KinectJoint j, const std::optional<Vec3>& hider, bool below) {
    Memory& memory = memories_[j];
    const std::uint64_t k = counter(t, j);
    const Vec3 seen = vec3(frames_.positions, t * kinect_joint_count + j);
    wander(memory, j, k);
    if (hider || below) {
      if (++memory.hidden == patience + 1) enter(memory, j, k, below);
    } else {
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

  /// Runs on whether it is used or not, so that it does not begin anew at each entry.
  void wander(Memory& memory, KinectJoint j, std::uint64_t k) {
    const KinectJointNoise& noise = kinect_joint_noise()[j];
    const double own = std::sqrt(1.0 - noise.kinship * noise.kinship);
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<Eigen::Index>(a);
      const auto [first, second] = random_.normals(k, 2 + 2 * a);
      const std::array<double, 2> fresh{first, second};
      for (std::size_t d = 0; d < 2; ++d) {
        const double kin = noise.source == j ? 0.0 : memories_[noise.source].draws[d][axis];
        memory.draws[d][axis] = noise.kinship * kin + own * fresh[d];
      }
      step_.run(memory.wandering[a], memory.draws[0][axis], memory.draws[1][axis]);
    }
  }

  void enter(Memory& memory, KinectJoint j, std::uint64_t k, bool below) {
    const KinectJointNoise& noise = kinect_joint_noise()[j];
    const Memory& kin = memories_[noise.source];
    const bool trunk = kinect_limbs[j].part == KinectPart::trunk;  // too large to be another part
    memory.infers = below || trunk || random_.chance(k, 0, gives_up);
    const Vec3 own(random_.normal(k, 8), random_.normal(k, 10), random_.normal(k, 12));
    const double shared = noise.source != j && kin.hidden > 0 ? noise.kinship : 0.0;
    memory.entry = shared * kin.entry + std::sqrt(1.0 - shared * shared) * own;
  }

  /// Where it is from its parent: what a guess begins with.
  void remember(std::size_t t, KinectJoint j, const Vec3& seen) {
    Memory& memory = memories_[j];
    memory.guess = seen;
    memory.bone =
        scene_.headings[t].axes.transpose() * (seen - memories_[kinect_limbs[j].parent].guess);
  }

  void put_guess(std::size_t t, KinectJoint j, const Vec3& seen, const std::optional<Vec3>& hider) {
    Memory& memory = memories_[j];
    const Memory& parent = memories_[kinect_limbs[j].parent];
    const Eigen::Matrix3d& axes = scene_.headings[t].axes;
    const bool root = kinect_limbs[j].parent == j;
    if (memory.hidden == 0 && memory.away <= 0.0) {
      remember(t, j, seen);
      return;
    }
    memory.guess = hider ? *hider : root ? seen : Vec3(parent.guess + axes * memory.bone);
    const GuessNoise size = guess_noise(kinect_limbs[j].part);
    const Vec3 error = size.at_entry * memory.entry + size.process * memory.wander();
    const Vec3 guessed = memory.guess + axes * error;
    vec3(frames_.positions, t * kinect_joint_count + j) =
        (1.0 - memory.away) * seen + memory.away * guessed;
  }

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
