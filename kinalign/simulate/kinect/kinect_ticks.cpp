// SPDX-License-Identifier: Apache-2.0
// The stamps of the sensor. kinect_draws.h lists its random number streams.
#include "kinalign/simulate/kinect/kinect_camera.h"
#include "kinalign/simulate/kinect/kinect_draws.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

// Steps in clock readings of 100 ns. Of three steps between frames, two are 32.98 ms and one is
// 34.03 ms (mean 33.33).
constexpr std::int64_t short_step = 329'800, long_step = 340'300, even_step = 333'300;
constexpr double tick_s = 1e-7;
constexpr double goes_on = 0.06;  // probability that the frame after a dropped frame is dropped too

/// Returns the step between frames k and k + 1. Each group of three steps has one long step at a
/// random position, so that long steps are evenly distributed.
std::int64_t step(const RandomStream& random, std::int64_t k, bool uneven) {
  if (!uneven) return even_step;
  const auto three = static_cast<std::uint64_t>(k / 3);
  const auto place =
      std::min<std::int64_t>(static_cast<std::int64_t>(3.0 * random.uniform(three, 0)), 2);
  return k % 3 == place ? long_step : short_step;
}

}  // namespace

std::vector<KinectTick> kinect_ticks(const KinectOptions& options, const KinectIds& ids,
                                     double begin_s, double end_s) {
  const RandomStream random = kinect_stream(KinectDraw::stamps, ids);
  const double share = std::clamp(options.drop_rate, 0.0, 0.9);
  // Probability that a frame after an accepted frame is dropped. With this value, `share` of all
  // frames are dropped.
  const double run_begins = share * (1.0 - goes_on) / (1.0 - share);
  const double rate = 1.0 + options.drift_ppm * 1e-6;
  std::vector<KinectTick> ticks;
  std::int64_t device = static_cast<std::int64_t>(
      std::llround(random.uniform(0, 1) * static_cast<double>(even_step)));
  bool dropped = false;
  for (std::int64_t k = 0;; ++k) {
    const double seconds = begin_s + static_cast<double>(device) * tick_s / rate;
    if (!(seconds < end_s)) return ticks;
    dropped = random.chance(static_cast<std::uint64_t>(k), 2, dropped ? goes_on : run_begins);
    if (!dropped) ticks.push_back({k, seconds, options.first_tick + device});
    device += step(random, k, options.parts.uneven_stamps);
  }
}

}  // namespace kinalign
