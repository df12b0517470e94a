// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/person/footsteps.h"

#include "kinalign/motion/rotation.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr double heel_before_s = 0.2;  // the heel leaves the floor this much earlier than the toes

/// Returns the position of the toes if the body is at `body`.
FloorPlace print_under(const FloorPlace& body, const FootShape& shape, double side, double narrow) {
  const double aside = side * shape.half_apart * narrow;
  const double yaw = body.yaw + side * shape.toes_out;
  return {body.x + aside * std::cos(body.yaw) + shape.length * std::sin(yaw),
          body.z - aside * std::sin(body.yaw) + shape.length * std::cos(yaw), yaw};
}

struct Gait {
  double narrow, lift_m, heel_rad;
};

/// Returns the shape of a step of length `far`, m. In walking, the toes are lifted by 3.5 cm, in
/// shorter steps by up to 6 cm.
Gait gait_of(const Act& act, double far, double scale) {
  if (act.piece == Piece::step) return {1.0, 0.11 * scale * act.amplitude, 0.30 * act.amplitude};
  const double reach = std::min(far / (0.8 * scale), 1.0);
  return {1.0 - 0.3 * reach, scale * (0.06 - 0.025 * reach), 0.25 + 0.4 * reach};
}

}  // namespace

// Each step of a foot begins where its last step ended, so a foot never slides. The step ends below
// the body's position in the middle of the next stance.
FootTrack::FootTrack(const std::vector<Act>& acts, const BodyPath& path, const FootShape& shape,
                     double side, double scale)
    : shape_(shape), start_(print_under(path.at(0.0), shape, side, 1.0)) {
  FloorPlace stands = start_;
  for (const Act& act : acts) {
    const StepTimes steps = step_times(act);
    for (std::size_t k = side == act.side ? 0 : 1; k < steps.count; k += 2) {
      // In the middle of its stance a foot is below the body, or slightly behind, because the heel
      // rises.
      const FloorPlace body = path.at(steps.lands(k) + 0.46 * steps.stance_s());
      const double far = std::hypot(print_under(body, shape, side, 1.0).x - stands.x,
                                    print_under(body, shape, side, 1.0).z - stands.z);
      const Gait gait = gait_of(act, far, scale);
      const FloorPlace to = print_under(body, shape, side, gait.narrow);
      swings_.push_back({steps.leaves(k), steps.lands(k), stands, to, gait.lift_m, gait.heel_rad});
      stands = to;
    }
  }
}

FootState FootTrack::at(double t) const {
  FootState foot;
  FloorPlace place = start_;
  double lift = 0.0, heel = 0.0;
  // The heel rises before the swing begins. The next swing is used as soon as its heel rises.
  const auto behind =
      std::upper_bound(swings_.begin(), swings_.end(), t + heel_before_s,
                       [](double at, const Swing& swing) { return at < swing.leaves_s; });
  if (behind != swings_.begin()) {
    const Swing& swing = *(behind - 1);
    const double length = swing.lands_s - swing.leaves_s, u = (t - swing.leaves_s) / length;
    const double share = glide(u);
    place = {swing.from.x + share * (swing.to.x - swing.from.x),
             swing.from.z + share * (swing.to.z - swing.from.z),
             swing.from.yaw + rise(u) * (swing.to.yaw - swing.from.yaw)};
    lift = swing.lift_m * bump(u);
    heel = swing.heel_rad *
           bump((t - swing.leaves_s + heel_before_s) / (0.8 * length + heel_before_s));
    foot.planted = u <= 0.0 || u >= 1.0;
  }
  foot.yaw = place.yaw;
  foot.rotation = rotation(Vec3(0, place.yaw, 0)) * rotation(Vec3(heel, 0, 0));
  foot.toes = Vec3(place.x, lift, place.z);
  // The toes are placed first; the ankle is computed from the rotation of the foot.
  foot.ankle = foot.toes - foot.rotation * Vec3(0.0, -shape_.height, shape_.length);
  return foot;
}

}  // namespace kinalign
