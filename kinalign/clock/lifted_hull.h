// SPDX-License-Identifier: Apache-2.0
// Keeps upper bounds on a function x(s), so that at any s the few decisive ones are found quickly.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace kinalign {

/// The lower convex hull of points (s, bound + rho s^2 / 2). If |x''| <= rho, a bound x(s_k) <= u_k
/// implies for a = x(t) and b = x'(t) that a + b (s_k - t) <= u_k + rho (s_k - t)^2 / 2. This right
/// side differs from the lifted point only by a term that is linear in s_k. So for every t only
/// corners of this one hull can be active. All values are in seconds, from an origin near the data:
/// doubles keep a nanosecond over 1000 hours.
class LiftedHull {
 public:
  /// Keeps the newest `corners` corners. With fewer corners the bounds are looser but still true.
  static constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
  explicit LiftedHull(double rho, std::size_t corners = all) : rho_(rho), most_(corners) {}

  /// Adds x(s) <= bound. Points may come in any order; a late one rebuilds the hull from there on.
  void add(double s, double bound);

  /// The bound on a = x(t) for a slope b = x'(t), and tau = s - t of the corner that gives it. The
  /// derivative of the bound by b is -tau.
  struct Support {
    double bound = 0.0;
    double tau = 0.0;
  };
  Support at(double t, double slope) const;
  /// The bounds for slopes first, first + step, ..., one for each element of `bounds`.
  void bounds_at(double t, double first, double step, std::span<double> bounds) const;
  /// The greatest `at(t, slope).bound` over all slopes, and its slope.
  struct Peak {
    double bound = 0.0;
    double slope = 0.0;
  };
  Peak peak(double t) const;

  bool empty() const { return corners_.empty(); }
  std::size_t size() const { return corners_.size(); }
  /// The same corners with another rho. Points above the old hull are lost, so the bounds may be
  /// looser.
  LiftedHull relifted(double rho) const;

 private:
  struct Corner {
    double s, lifted;
    double slope;  // slope of the edge to the next corner; infinite for the last one
  };
  std::vector<Corner>::const_iterator corner_for(double slope) const;
  Support support(const Corner& corner, double t, double slope) const;
  void append(double s, double lifted);

  double rho_;
  std::size_t most_;
  std::vector<Corner> corners_;  // s and slope are in rising order
};

}  // namespace kinalign
