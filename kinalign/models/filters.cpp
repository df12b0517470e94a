// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/filters.h"

#include "kinalign/models/body_frame.h"

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace kinalign {

namespace {

constexpr double trusted_inferred_s = 0.2;

using State = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

float* place(JointFrames& body, std::size_t frame, std::size_t joint) {
  return &body.positions[(frame * body.joints + joint) * 3];
}

/// The weight of a new value in a first-order low-pass with this cut-off frequency.
double share_of(double cut_hz, double rate_hz) {
  const double r = 2.0 * std::numbers::pi * cut_hz / rate_hz;
  return r / (r + 1.0);
}

struct Step {
  State predicted, filtered;
  Matrix predicted_spread, filtered_spread;
};

/// The Kalman filter and smoother of one axis of one joint.
/// The model is a point with constant acceleration that white jerk disturbs; the
/// state is position, speed and acceleration. begin() starts a joint, add() takes frames in order,
/// and smoothed() goes backwards over the kept steps.
class AxisSmoother {
 public:
  AxisSmoother(const Kalman& how, double rate_hz) {
    const double d = 1.0 / rate_hz, d2 = d * d, d3 = d2 * d;
    turn_ << 1, d, d2 / 2, 0, 1, d, 0, 0, 1;
    noise_ << d3 * d2 / 20, d2 * d2 / 8, d3 / 6, d2 * d2 / 8, d3 / 3, d2 / 2, d3 / 6, d2 / 2, d;
    noise_ *= how.jerk;
  }

  /// At the start the variances (m^2, m^2/s^2 and m^2/s^4) of speed and acceleration are large, so
  /// that the first measurements decide both.
  void begin(double value) {
    steps_.clear();
    state_ = {value, 0.0, 0.0};
    spread_ = Eigen::Vector3d(0.01, 1.0, 100.0).asDiagonal();
  }

  /// `variance`: of the measurement; absent: the value is not a measurement.
  void add(double value, std::optional<double> variance) {
    Step step;
    step.predicted = steps_.empty() ? state_ : State(turn_ * state_);
    step.predicted_spread =
        steps_.empty() ? spread_ : Matrix(turn_ * spread_ * turn_.transpose() + noise_);
    step.filtered = step.predicted;
    step.filtered_spread = step.predicted_spread;
    if (variance) {
      const double innovation = value - step.predicted(0);
      double total = step.predicted_spread(0, 0) + *variance;
      // An outlier gets less weight: beyond 3 sigma the measurement's variance grows with its
      // error.
      total *= std::max(1.0, innovation * innovation / (9.0 * total));
      const State gain = step.predicted_spread.col(0) / total;
      step.filtered += gain * innovation;
      step.filtered_spread -= gain * step.predicted_spread.row(0);
      // Rounding makes the matrix unsymmetric, and later steps would enlarge the error.
      step.filtered_spread = 0.5 * (step.filtered_spread + step.filtered_spread.transpose()).eval();
    }
    state_ = step.filtered;
    spread_ = step.filtered_spread;
    steps_.push_back(step);
  }

  /// The positions of all steps after the backward pass of the smoother.
  /// Rauch, Tung and Striebel: the filtered state of a frame is corrected by how far the smoothed
  /// state of the next frame lies from its prediction.
  std::vector<double> smoothed() const {
    std::vector<double> out(steps_.size());
    State after = steps_.back().filtered;
    out.back() = after(0);
    for (std::size_t i = steps_.size() - 1; i-- > 0;) {
      const Step& here = steps_[i];
      const Step& next = steps_[i + 1];
      const Matrix gain =
          here.filtered_spread * turn_.transpose() * next.predicted_spread.inverse();
      after = here.filtered + gain * (after - next.predicted);
      out[i] = after(0);
    }
    return out;
  }

 private:
  Matrix turn_, noise_, spread_;
  State state_;
  std::vector<Step> steps_;
};

}  // namespace

void hold(JointFrames& body, double rate_hz) {
  const auto trusted = static_cast<std::size_t>(trusted_inferred_s * rate_hz);
  for (std::size_t j = 0; j < body.joints; ++j) {
    // An inferred joint is a guess of the Kinect and is used only for a short time. In a longer run
    // of inferred frames the joint counts as missing.
    std::size_t inferred = 0;
    for (std::size_t t = 0; t < body.frames(); ++t) {
      std::uint8_t& seen = body.seen[t * body.joints + j];
      inferred = seen == 1 ? inferred + 1 : 0;
      if (inferred > trusted) seen = 0;
    }
  }
  fill_missing(body, true);
}

// The formulas are those of Casiez et al. (filters.h). The derivative uses the previous filtered
// position, as in theirs.
void one_euro(const OneEuro& how, JointFrames& body, double rate_hz) {
  fill_missing(body, true);
  const double slow = share_of(how.derivative_hz, rate_hz);
  for (std::size_t j = 0; j < body.joints; ++j) {
    std::array<double, 3> at{}, speed{};
    for (std::size_t t = 0; t < body.frames(); ++t) {
      float* now = place(body, t, j);
      double square = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        if (t == 0) at[k] = now[k];
        speed[k] += slow * ((now[k] - at[k]) * rate_hz - speed[k]);
        square += speed[k] * speed[k];
      }
      const double share = share_of(how.least_hz + how.slope * std::sqrt(square), rate_hz);
      for (std::size_t k = 0; k < 3; ++k) {
        at[k] += share * (now[k] - at[k]);
        now[k] = static_cast<float>(at[k]);
      }
    }
  }
}

void kalman_smooth(const Kalman& how, JointFrames& body, double rate_hz) {
  if (body.frames() == 0) return;
  JointFrames filled = body;
  fill_missing(filled, false);
  AxisSmoother smoother(how, rate_hz);
  for (std::size_t j = 0; j < body.joints; ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      // Filled positions only start the filter. If a joint is missing, add() gets no variance, and
      // the filter predicts.
      smoother.begin(place(filled, 0, j)[k]);
      for (std::size_t t = 0; t < body.frames(); ++t) {
        const std::uint8_t seen = body.seen[t * body.joints + j];
        const double sigma = seen == 2 ? how.tracked_m : how.inferred_m;
        smoother.add(place(filled, t, j)[k],
                     seen == 0 ? std::nullopt : std::optional(sigma * sigma));
      }
      const std::vector<double> values = smoother.smoothed();
      for (std::size_t t = 0; t < body.frames(); ++t) {
        place(body, t, j)[k] = static_cast<float>(values[t]);
      }
    }
  }
}

}  // namespace kinalign
