// SPDX-License-Identifier: Apache-2.0
#include "kinalign/resample/taken_step.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

TakenStep taken_step(const RecordedStream& s, const StreamOptions& options, Role role) {
  // The step is known precisely enough if another measure of the step is within these shares. For
  // KinectMultiTrack the median is 34 ms and the usual mean 32.2 to 33.3 ms.
  constexpr double quite_another = 1.5, stated = 0.05, usual = 0.08, mean = 0.03;
  constexpr double usual_to_mean = 0.12;  // stalls: 10 %; rounded stamps: 15 % and more
  // A slow loop is recognised if at least one sample in this many was read together with the next.
  constexpr std::uint64_t loop = 50;
  const std::int64_t stated_ns = usual_step_ns(s, options);
  const auto stated_step = static_cast<double>(stated_ns);
  const auto median = static_cast<double>(s.survey.median_step_ns);
  const auto near = [](double one, double other, double share) {
    return std::abs(one - other) < share * other;
  };
  // A step that the stream itself states is exact, for example the frame time of a BVH.
  if (s.step_ns || median <= 0.0) return {stated_ns, role, true};
  // usual_step is the mean of the usual steps only, so stalls do not change it.
  const auto usual_step = static_cast<double>(s.survey.usual_step_ns);
  const bool another =
      stated_step >= quite_another * median || quite_another * stated_step <= median;
  const bool looped = loop * s.survey.read_at_once > s.survey.kept();
  if (another || (looped && near(stated_step, usual_step, stated))) return {stated_ns, role, true};
  const auto all = static_cast<double>((s.survey.last - s.survey.first).count());
  const double mean_step =
      all / static_cast<double>(std::max<std::uint64_t>(2, s.survey.kept()) - 1);
  const bool steady = near(usual_step, median, usual) ||
                      (near(mean_step, median, mean) && near(usual_step, median, usual_to_mean)) ||
                      (options.rate_hz > 0.0 && near(stated_step, median, stated));
  return {s.survey.median_step_ns, role, steady};
}

}  // namespace kinalign
