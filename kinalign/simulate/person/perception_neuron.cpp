// SPDX-License-Identifier: Apache-2.0
// Random numbers (random.h): stream 100 of a person's seed has these lanes: 0 legs, 2 arms, 4 width
// of hips and shoulders, 6 feet. The deviations are estimates from the variation of segments
// relative to stature in Drillis and Contini's tables, as printed by Winter (Biomechanics and Motor
// Control of Human Movement, chapter 4).
#include "kinalign/simulate/person/perception_neuron.h"

#include "kinalign/simulate/random.h"

#include <algorithm>
#include <string>

namespace kinalign {

namespace {

constexpr double file_height_m = 1.75;
constexpr double leg_cm = 1.59 + 2.0 * 41.87 + 7.69;  // distance from the hips to the sole
constexpr double trunk_cm = 14.307 + 9.718 + 10.12 + 9.718 + 10.387 + 9.47 + 15.95;

/// Factors for the lengths of the file.
struct Proportions {
  double leg = 1.0, trunk = 1.0, arm = 1.0, width = 1.0, foot = 1.0;
};

// Deviations are limited to two standard deviations, so that no body is unnatural. The trunk
// compensates for the legs.
Proportions proportions(double height_m, std::uint64_t person) {
  const double scale = height_m / file_height_m;
  if (person == 0) return {scale, scale, scale, scale, scale};
  const RandomStream random(person, 100);
  const auto near_one = [&](std::uint64_t lane, double deviation) {
    return 1.0 + deviation * std::clamp(random.normal(0, lane), -2.0, 2.0);
  };
  Proportions of;
  const double leg = near_one(0, 0.02);
  of.leg = scale * leg;
  of.trunk = scale * (1.0 - (leg - 1.0) * leg_cm / trunk_cm);  // keeps the height of the person
  of.arm = scale * near_one(2, 0.025);
  of.width = scale * near_one(4, 0.03);
  of.foot = scale * near_one(6, 0.025);
  return of;
}

/// Adds joints in the order of the file. `side` is +1 for the left and -1 for the right.
class Builder {
 public:
  explicit Builder(const Proportions& of) : of_(of) {}

  /// Adds a joint and returns its index. Parents must be added before their children.
  int add(std::string name, int parent, const Vec3& offset_cm) {
    skeleton_.joint_names.push_back(std::move(name));
    skeleton_.parents.push_back(parent);
    skeleton_.rest_offsets.emplace_back(0.01 * offset_cm);
    return static_cast<int>(skeleton_.joints()) - 1;
  }
  void end(int parent, const Vec3& offset_cm) {
    skeleton_.end_sites.push_back({parent, 0.01 * offset_cm});
  }

  int hips() { return add("Hips", -1, Vec3(0, of_.leg * leg_cm, 0)); }

  void leg(const std::string& side_name, double side, int hips) {
    const int up = add(side_name + "UpLeg", hips, {of_.width * 9.25 * side, -of_.leg * 1.59, 0});
    const int low = add(side_name + "Leg", up, {0, -of_.leg * 41.87, 0});
    const int foot = add(side_name + "Foot", low, {0, -of_.leg * 41.87, 0});
    end(foot, {0, -of_.leg * 7.69, of_.foot * 17.5});
  }

  /// Adds the joints from the hips to the head. Returns the joint at which the shoulders begin.
  int trunk(int hips) {
    const auto up = [&](double cm) -> Vec3 { return {0, of_.trunk * cm, 0}; };
    const int spine = add("Spine", hips, up(14.307));
    const int spine1 = add("Spine1", spine, up(9.718));
    const int spine2 = add("Spine2", spine1, up(10.12));
    const int spine3 = add("Spine3", spine2, up(9.718));
    const int neck = add("Neck", spine3, up(10.387));
    const int head = add("Head", neck, up(9.47));
    end(head, up(15.95));
    return spine3;
  }

  void arm(const std::string& side_name, double side, int chest) {
    const auto out = [&](double cm) -> Vec3 { return {of_.arm * cm * side, 0, 0}; };
    const int shoulder =
        add(side_name + "Shoulder", chest, {of_.width * 3.2 * side, of_.trunk * 6.925, 0});
    const int arm = add(side_name + "Arm", shoulder, {of_.width * 12.8 * side, 0, 0});
    const int fore = add(side_name + "ForeArm", arm, out(26.5));
    hand(side_name, side, add(side_name + "Hand", fore, out(26.0)));
  }

  Skeleton take() { return std::move(skeleton_); }

 private:
  void hand(const std::string& side_name, double side, int hand) {
    const double a = of_.arm;
    const std::string name = side_name + "Hand";
    finger(name + "Thumb", hand, {a * 2.5 * side, -a * 0.3, a * 3.0}, side);
    double across = 2.4;  // cm, from the middle of the hand forwards to the base of the finger
    for (const char* one : {"Index", "Middle", "Ring", "Pinky"}) {
      const int palm =
          add(side_name + "InHand" + one, hand, {a * 3.4 * side, a * 0.4, a * 0.6 * across});
      finger(name + one, palm, {a * 5.3 * side, 0, a * 0.4 * across}, side);
      across -= 1.6;
    }
  }

  void finger(const std::string& name, int parent, const Vec3& root_cm, double side) {
    const auto out = [&](double cm) -> Vec3 { return {of_.arm * cm * side, 0, 0}; };
    const int first = add(name + "1", parent, root_cm);
    const int second = add(name + "2", first, out(3.6));
    end(add(name + "3", second, out(2.2)), out(1.9));
  }

  Proportions of_;
  Skeleton skeleton_;
};

}  // namespace

Skeleton perception_neuron(double height_m, std::uint64_t person) {
  Builder build(proportions(height_m, person));
  const int hips = build.hips();
  build.leg("Right", -1.0, hips);
  build.leg("Left", 1.0, hips);
  const int chest = build.trunk(hips);
  build.arm("Right", -1.0, chest);
  build.arm("Left", 1.0, chest);
  return build.take();
}

}  // namespace kinalign
