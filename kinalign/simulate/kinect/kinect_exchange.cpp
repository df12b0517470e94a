// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/kinect/kinect_exchange.h"

#include "kinalign/simulate/kinect/kinect_coloured.h"
#include "kinalign/simulate/kinect/kinect_draws.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace kinalign {

namespace {

enum class Group : std::uint8_t { body, legs, arms };

struct Shares {
  Group group;
  double sideways;  // share of frames, if one side is exactly behind the other
};
// Fitted to two Kinects at 0, 45 and 90 degrees; one of them sometimes looks along the shoulders.
constexpr std::array<Shares, 3> groups{
    {{Group::body, 0.07}, {Group::legs, 0.16}, {Group::arms, 0.14}}};
// The tracker confuses labels when limbs pass each other, and less often if the body stands. At 90
// degrees the two Kinects differ by 9.8 cm while it stands and by 13.6 cm while it steps.
constexpr double still_share = 0.4, full_bustle = 0.25;  // m/s
// While a turning body is seen from the side, labels stay right for this long. An estimate.
constexpr double labels_hold_s = 2.0;
// If the sides are farther apart in the image than this, they are not confused, m.
constexpr double distinct = 0.25;

// Estimates: durations are log-normal with a median of 0.4 s. back_misread is the probability that
// a turned back is taken for a front.
constexpr double median_s = 0.4, spread = 0.5;
constexpr double mean_s = median_s * 1.1331484530668263;  // exp(spread^2 / 2)
constexpr double back_from = 110.0 * std::numbers::pi / 180.0;
constexpr double turn_s = 4.0;  // cameras that see a back within this time make the same error
constexpr double back_misread = 0.04;

bool in_group(KinectLimb place, Group group) {
  if (place.side == KinectSide::middle) return false;
  if (group == Group::body) return true;
  return (group == Group::arms) == (place.part == KinectPart::arm);
}

/// Exchanges left and right of a group in frame t.
void exchange(PointFrames& frames, std::size_t t, Group group) {
  for (std::size_t j = 0; j < kinect_joint_count; ++j) {
    const KinectLimb& place = kinect_limbs[j];
    if (place.side != KinectSide::left || !in_group(place, group)) continue;
    const std::size_t left = t * kinect_joint_count + j;
    const std::size_t right = t * kinect_joint_count + place.partner;
    std::swap(frames.state[left], frames.state[right]);
    for (std::size_t a = 0; a < 3; ++a) {
      std::swap(frames.positions[3 * left + a], frames.positions[3 * right + a]);
    }
  }
}

/// Returns 1 if left and right of a group are behind each other in the camera's view, and 0 if they
/// are at least `distinct` apart.
double confusable(std::span<const double> joints, Group group) {
  double apart = 0.0, pairs = 0.0;
  for (std::size_t j = 0; j < kinect_joint_count; ++j) {
    const KinectLimb& place = kinect_limbs[j];
    if (place.side != KinectSide::left || !in_group(place, group)) continue;
    const Vec3 left = vec3(joints, j), right = vec3(joints, place.partner);
    const Vec3 way = (left + right).normalized();
    const Vec3 across = left - right;
    apart += (across - across.dot(way) * way).norm();
    pairs += 1.0;
  }
  return std::pow(std::max(0.0, 1.0 - apart / pairs / distinct), 2);
}

/// Cameras side by side make the same errors, so they use the same random number at the same time.
std::uint64_t shared_key(double seconds, double each_s) {
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(seconds / each_s)));
}

/// Periods in which sides are exchanged. Their lengths and the times between them are drawn so that
/// they cover a given share of the frames.
class Spells {
 public:
  Spells(RandomStream random, std::uint64_t lane) : random_(random), lane_(lane) {}

  /// Returns whether the frame is in such a period. `likeness`: result of confusable(), averaged
  /// over labels_hold_s.
  bool step(const KinectTick& tick, double step_s, double share, double likeness) {
    if (!lasted_) lasted_ = likeness;
    *lasted_ += (likeness - *lasted_) * step_s / labels_hold_s;
    if (tick.seconds < until_) return true;
    const std::uint64_t k = shared_key(tick.seconds, kinect_frame_s);
    // Rate of beginning periods at which they cover this share of the frames.
    const double now = share * *lasted_;
    const double rate = now / ((1.0 - now) * mean_s);
    if (!random_.chance(k, lane_, rate * step_s)) return false;
    until_ = tick.seconds + median_s * std::exp(spread * random_.normal(k, lane_ + 1));
    return true;
  }

 private:
  RandomStream random_;
  std::uint64_t lane_;
  double until_ = -1e300;
  std::optional<double> lasted_;
};

}  // namespace

void exchange_sides(const KinectScene& scene, const KinectIds& ids, PointFrames& frames) {
  const RandomStream random = kinect_take_stream(KinectDraw::exchange, ids);
  std::array<Spells, 3> spells{Spells(random, 0), Spells(random, 4), Spells(random, 8)};
  bool back = false, misread = false;
  double before = scene.frames() > 0 ? scene.ticks[0].seconds : 0.0;
  for (std::size_t t = 0; t < scene.frames(); ++t) {
    const KinectTick& tick = scene.ticks[t];
    const double yaw = scene.headings[t].yaw;
    // Without the limit, a gap in the frames would always begin a period.
    const double step_s = std::min(tick.seconds - before, 0.1);
    before = tick.seconds;
    const double moved =
        still_share + (1.0 - still_share) * std::min(1.0, scene.bustle[t] / full_bustle);
    const bool turned = yaw > back_from;
    if (turned && !back)
      misread = random.chance(shared_key(tick.seconds, turn_s), 12, back_misread);
    back = turned;
    if (back && misread) {
      exchange(frames, t, Group::body);
      continue;
    }
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const double likeness = confusable(scene.joints(t), groups[g].group);
      const double share = moved * groups[g].sideways * likeness;
      if (spells[g].step(tick, step_s, share, likeness)) exchange(frames, t, groups[g].group);
    }
  }
}

}  // namespace kinalign
