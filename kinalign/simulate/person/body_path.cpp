// SPDX-License-Identifier: Apache-2.0
// A point walks from goal to goal with limited speed, acceleration and rate of turning. Its
// positions every 0.2 s are the control points of the path. Random numbers (random.h): stream 103
// of a seed, by the number of the goal in the whole motion, has these lanes: 0 direction, 1
// distance, 2 angle of the turn.
#include "kinalign/simulate/person/body_path.h"

#include "kinalign/simulate/random.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace kinalign {

namespace {

using std::numbers::pi;
constexpr double control_s = 0.2;
constexpr double tick_s = 0.05;  // four ticks for each control point
// rad/s, estimated: a quarter turn takes 1.3 s and two steps
constexpr double most_turn_rate = 1.2;
constexpr double most_acceleration = 1.0;  // m/s2
// A goal is reached if the distance is at most this.
constexpr double arrival_m = 0.2;

// Returns the same angle between -pi and pi.
double wrapped(double angle) { return std::remainder(angle, 2.0 * pi); }

/// Moves the point in small time steps (ticks), act by act. Small steps are needed because the body
/// must be back at the origin at the end of each act. Only the control points are stored; the path
/// through them is smooth.
class Walker {
 public:
  Walker(std::uint64_t seed, double scale) : random_(seed, 103), scale_(scale) {}

  const FloorPlace& place() const { return place_; }

  /// Call when an act begins, before its first tick.
  void begin(const Act& act) {
    const StepTimes steps = step_times(act);
    act_ = &act;
    may_move_from_ = steps.first_s;
    // The last two steps bring the feet under the body, which has already stopped.
    rest_from_ = steps.count < 4 ? steps.first_s : steps.leaves(steps.count - 2);
    going_home_ = turning_ = false;
    goal_number_ = 0;
    choose();
  }

  /// Moves the point by one tick. Outside the steps the point slows down and stops.
  void tick(double t) {
    const bool moves = t >= may_move_from_ && t < rest_from_ && act_->piece != Piece::step;
    if (!moves) {
      approach(0.0);
    } else if (act_->piece == Piece::turn) {
      turn(t);
    } else {
      walk(t);
    }
    place_.x += speed_ * std::sin(place_.yaw) * tick_s;
    place_.z += speed_ * std::cos(place_.yaw) * tick_s;
  }

 private:
  // m/s; grows with the root of the person's size, like the speed of a pendulum
  double top_speed() const { return act_->speed * std::sqrt(scale_); }

  /// Chooses the next goal of the act: a position, or an angle for a turn.
  void choose() {
    const std::uint64_t n = goals_++;
    ++goal_number_;
    if (act_->piece == Piece::walk) {
      const double end = goal_number_ % 2 == 1 ? 0.9 : -0.9;
      goal_ = {0.3 * (random_.uniform(n, 1) - 0.5), end, 0.0};
    } else {
      const double direction = 2.0 * pi * random_.uniform(n, 0);
      const double distance = std::sqrt(random_.uniform(n, 1));
      goal_ = {distance * std::sin(direction), distance * std::cos(direction), 0.0};
    }
    const double turns = random_.chance(n, 2, 0.6) ? 0.5 * pi : pi;
    goal_.yaw = place_.yaw + act_->side * turns;
    hold_s_ = 0.5;
  }

  /// Changes the speed towards `speed`, limited by the greatest acceleration.
  void approach(double speed) {
    speed_ += std::clamp(speed - speed_, -most_acceleration * tick_s, most_acceleration * tick_s);
  }
  /// Turns towards a yaw. Returns the difference before the turn, rad.
  double steer(double yaw) {
    const double off = yaw - place_.yaw;
    place_.yaw += std::clamp(4.0 * off, -most_turn_rate, most_turn_rate) * tick_s;
    return std::abs(off);
  }
  /// Returns the nearest yaw that faces +z. Full turns are not undone.
  double home_yaw() const { return 2.0 * pi * std::round(place_.yaw / (2.0 * pi)); }

  /// Turns in place to each goal, and back to the front before the act ends.
  void turn(double t) {
    approach(0.0);
    // Time for the turn to the front, plus one second.
    const double needed = std::abs(home_yaw() - place_.yaw) / most_turn_rate + 1.0;
    if (rest_from_ - t < needed) going_home_ = true;
    if (going_home_) {
      steer(home_yaw());
    } else if (steer(goal_.yaw) < 0.05) {
      hold_s_ -= tick_s;
      if (hold_s_ < 0.0) choose();
    }
  }

  /// Walks to each goal, and returns to the origin in time for the turn to the front.
  void walk(double t) {
    const double away = std::hypot(place_.x, place_.z);
    // Time for the way back at 0.7 of the speed, for turning towards the origin, and for turning to
    // the front.
    const double needed = away / (0.7 * top_speed()) + (away > 0.15 ? pi / most_turn_rate : 0.0) +
                          std::abs(wrapped(place_.yaw)) / most_turn_rate + 1.5;
    if (rest_from_ - t < needed) going_home_ = true;
    const FloorPlace target = going_home_ ? FloorPlace{} : goal_;
    const double dx = target.x - place_.x, dz = target.z - place_.z;
    const double distance = std::hypot(dx, dz);
    if (going_home_ && (turning_ || distance < 0.08)) {
      turning_ = true;  // at the origin: turns to the front
      approach(0.0);
      steer(home_yaw());
      return;
    }
    if (!going_home_ && distance < arrival_m) choose();
    const double off = wrapped(std::atan2(dx, dz) - place_.yaw);
    steer(place_.yaw + off);
    // The body slows down before a sharp turn and near the goal.
    const double ahead = std::max(0.0, std::cos(off));
    approach(std::min(top_speed() * ahead * ahead, std::sqrt(most_acceleration * distance)));
  }

  RandomStream random_;
  double scale_;
  FloorPlace place_, goal_;
  const Act* act_ = nullptr;
  double speed_ = 0.0, hold_s_ = 0.0;
  double may_move_from_ = 0.0, rest_from_ = 0.0;
  bool going_home_ = false, turning_ = false;
  std::uint64_t goals_ = 0, goal_number_ = 0;
};

struct Controls {
  std::vector<double> x, z, yaw;
};

/// Walks through all acts and stores the point's position for each control point.
Controls walked(const std::vector<Act>& acts, std::uint64_t seed, double scale) {
  Controls controls;
  Walker walker(seed, scale);
  std::optional<std::uint64_t> current;
  const auto count = static_cast<std::size_t>(acts.back().end_s / control_s) + 2;
  // The position is stored before the ticks of its interval.
  const auto ticks = static_cast<std::size_t>(std::lround(control_s / tick_s));
  for (std::size_t k = 0; k < count; ++k) {
    controls.x.push_back(walker.place().x);
    controls.z.push_back(walker.place().z);
    controls.yaw.push_back(walker.place().yaw);
    for (std::size_t i = 0; i < ticks; ++i) {
      const double t = control_s * static_cast<double>(k) + tick_s * static_cast<double>(i);
      const Act& act = act_at(acts, t);
      if (current != act.number) walker.begin(act);
      current = act.number;
      walker.tick(t);
    }
  }
  return controls;
}

}  // namespace

// The first foot leaves the floor 0.4 s after the act begins. The last foot lands at least 0.3 s
// before the act ends. An act without time for two steps has no steps.
StepTimes step_times(const Act& act) {
  StepTimes steps;
  if (!act.has_steps()) return steps;
  steps.first_s = act.begin_s + 0.4;
  steps.stride_s = act.tempo_s;
  steps.swing_s = 0.4 * steps.stride_s;
  const double room = act.end_s - 0.3 - steps.lands(0);
  if (room < 0.5 * steps.stride_s) return steps;
  steps.count = static_cast<std::size_t>(room / (0.5 * steps.stride_s)) + 1;
  return steps;
}

BodyPath::BodyPath(const std::vector<Act>& acts, std::uint64_t seed, double scale)
    : x_(control_s, {}), z_(control_s, {}), yaw_(control_s, {}) {
  Controls controls = walked(acts, seed, scale);
  x_ = ControlTrack(control_s, std::move(controls.x));
  z_ = ControlTrack(control_s, std::move(controls.z));
  yaw_ = ControlTrack(control_s, std::move(controls.yaw));
}

}  // namespace kinalign
