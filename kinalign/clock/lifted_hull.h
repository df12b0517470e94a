// SPDX-License-Identifier: Apache-2.0
// Stores upper bounds on a function x(s) so that the few bounds that matter at any s are found
// quickly.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace kinalign {

/// The lower convex hull of the points (s, bound + rho s^2 / 2). Let |x''| <= rho, a = x(t) and b =
/// x'(t). Then a bound x(s_k) <= u_k implies a + b (s_k - t) <= u_k + rho (s_k - t)^2 / 2. This
/// right side equals the hull's point plus a term that is linear in s_k. For every t, only corners
/// of this hull therefore limit a. All values are in seconds from an origin near the data, so
/// doubles are exact to a nanosecond over 1000 hours.
class LiftedHull {
 public:
  /// Keeps the newest `corners` corners. With fewer corners the bounds are wider but still correct.
  static constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
  explicit LiftedHull(double rho, std::size_t corners = all) : rho_(rho), most_(corners) {}

  /// Adds x(s) <= bound in any order. A late point rebuilds the hull from that point on.
  void add(double s, double bound);

  /// The bound on a = x(t) for the slope b = x'(t), and tau = s - t of the corner that gives the
  /// bound. The derivative of the bound with respect to b is -tau.
  struct Support {
    double bound = 0.0;
    double tau = 0.0;
  };
  Support at(double t, double slope) const;
  /// Computes the bounds for the slopes first, first + step, ..., one for each element of `bounds`.
  void bounds_at(double t, double first, double step, std::span<double> bounds) const;
  /// The greatest value of at(t, slope).bound over all slopes, and the slope that gives it.
  struct Peak {
    double bound = 0.0;
    double slope = 0.0;
  };
  Peak peak(double t) const;

  bool empty() const { return corners_.empty(); }
  std::size_t size() const { return corners_.size(); }
  /// Returns the hull of the same corners with another rho. Points above the old hull are not
  /// stored, so the new bounds may be wider.
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
