// SPDX-License-Identifier: Apache-2.0
// Bounds on a function x(s) from above, kept so that at any s the few that matter are found at
// once.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace kinalign {

/// The lower convex hull of points (s, bound + rho s^2 / 2). If |x''| <= rho, a bound x(s_k) <= u_k
/// says of a = x(t) and b = x'(t) that a + b (s_k - t) <= u_k + rho (s_k - t)^2 / 2; that right
/// side differs from the lifted point by what is linear in s_k alone. So for every t only corners
/// of this one hull can be active. Seconds throughout, from an origin near the data: doubles keep a
/// nanosecond over 1000 hours.
class LiftedHull {
 public:
  /// Remembers so many corners, the newest: fewer bound less, and truly.
  static constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
  explicit LiftedHull(double rho, std::size_t corners = all) : rho_(rho), most_(corners) {}

  /// x(s) <= bound. Points may come in any order; late ones reopen the tail.
  void add(double s, double bound);

  /// The bound on a = x(t) that a slope b = x'(t) leaves, and the corner that gives it, as
  /// s - t: the bound's derivative by b is its negative.
  struct Support {
    double bound = 0.0;
    double tau = 0.0;
  };
  Support at(double t, double slope) const;
  /// The bounds of slopes that rise by `step` from `first` on, one for each place of `bounds`.
  void bounds_at(double t, double first, double step, std::span<double> bounds) const;
  /// The greatest `at(t, slope).bound` over all slopes, and the slope there.
  struct Peak {
    double bound = 0.0;
    double slope = 0.0;
  };
  Peak peak(double t) const;

  bool empty() const { return corners_.empty(); }
  std::size_t size() const { return corners_.size(); }
  /// The same corners under another rho; what lay above them before is not known any more.
  LiftedHull relifted(double rho) const;

 private:
  struct Corner {
    double s, lifted;
    double slope;  // of the edge to the next corner; the last one's is infinite
  };
  std::vector<Corner>::const_iterator corner_for(double slope) const;
  Support support(const Corner& corner, double t, double slope) const;
  void append(double s, double lifted);

  double rho_;
  std::size_t most_;
  std::vector<Corner> corners_;  // s and slope rising
};

}  // namespace kinalign
