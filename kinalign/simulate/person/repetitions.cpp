// SPDX-License-Identifier: Apache-2.0
// Random numbers (random.h): stream 105 of a seed, by 4096 times the number of the act plus the
// number of the repetition, has these lanes: 0 length, 1 and 2 duration of the movement there and
// back, 3 amplitude.
#include "kinalign/simulate/person/repetitions.h"

#include "kinalign/simulate/random.h"
#include "kinalign/simulate/smooth.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

double Repetition::size(double t) const {
  const double x = share(t);
  return amplitude * rise(x / forth) * rise((1.0 - x) / back);
}

// The lengths are drawn first and then scaled, so that they fill the time exactly.
std::vector<Repetition> drawn_repetitions(const RepetitionPlan& plan, std::uint64_t seed) {
  const RandomStream random(seed, 105);
  const double room = plan.end_s - plan.begin_s;
  const auto count = static_cast<std::uint64_t>(std::max(1.0, std::floor(room / plan.tempo_s)));
  const auto between = [&](std::uint64_t i, std::uint64_t lane, double least, double most) {
    return least + (most - least) * random.uniform(4096 * plan.number + i, lane);
  };
  double all = 0.0;
  for (std::uint64_t i = 0; i < count; ++i) all += between(i, 0, 0.8, 1.2);
  std::vector<Repetition> out;
  double sum = 0.0;
  for (std::uint64_t i = 0; i < count; ++i) {
    Repetition one;
    one.begin_s = plan.begin_s + room * sum / all;
    sum += between(i, 0, 0.8, 1.2);
    one.end_s = plan.begin_s + room * sum / all;
    one.forth = between(i, 1, 0.36, 0.46);
    one.back = between(i, 2, 0.36, 0.46);
    one.amplitude = between(i, 3, 0.85, 1.15);
    one.side = i % 2 == 0 ? plan.first_side : -plan.first_side;
    out.push_back(one);
  }
  return out;
}

const Repetition& repetition_at(const std::vector<Repetition>& all, double t) {
  const auto behind =
      std::upper_bound(all.begin() + 1, all.end(), t,
                       [](double at, const Repetition& one) { return at < one.begin_s; });
  return *(behind - 1);
}

}  // namespace kinalign
