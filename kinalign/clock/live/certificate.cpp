// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/live/certificate.h"

#include <fmt/format.h>

namespace kinalign {

std::string to_string(const Assumptions& assumptions) {
  return fmt::format("H1-H5 rate<={:g}ppm curvature<={:g}ppm/s", assumptions.rate * 1e6,
                     assumptions.curvature * 1e6);
}

void Certificate::add(const Bound& bound) {
  corridor_.add(bound);
  ++(bound.side == Side::above ? up_ : down_);
}

std::optional<ValueRange> Certificate::at(double t) const {
  if (corridor_.above.empty() || corridor_.below.empty()) return std::nullopt;
  const CorridorLine widest = widest_line(corridor_, t, assumptions_.rate);
  return value_range(corridor_, t, assumptions_.rate, widest);
}

Certificate Certificate::relaxed(double curvature) const {
  Certificate other = *this;
  other.assumptions_.curvature = curvature;
  other.corridor_.above = corridor_.above.relifted(curvature);
  other.corridor_.below = corridor_.below.relifted(curvature);
  return other;
}

}  // namespace kinalign
