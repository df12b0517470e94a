// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/own_body.h"

#include "tests/models/pose/pose_people.h"

#include "kinalign/simulate/person/perception_neuron.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

/// The body of a person who differs from those of these tests' suits.
Skeleton other_body() { return pose_body(test_offsets()).skeleton; }

}  // namespace

TEST_CASE("the stature that a body is scaled to is the one that it has then") {
  const Skeleton body = other_body();
  const Skeleton taller = scaled(body, 1.9 / stature_of(body));
  CHECK(stature_of(taller) == doctest::Approx(1.9));
  CHECK(leg_length(taller) == doctest::Approx(0.48 * 1.9));
  CHECK(leg_length(body) == doctest::Approx(0.82));
}

TEST_CASE("a body with a suit's lengths has the suit's limbs and its own directions") {
  const Skeleton body = other_body();
  for (const double height : {1.55, 1.75, 1.95}) {
    const Skeleton suit = perception_neuron(height, 3);
    const auto own = with_lengths_of(body, suit);
    REQUIRE(own);
    CHECK(stature_of(*own) == doctest::Approx(height).epsilon(0.05));
    const auto length = [&](const char* joint) {
      for (std::size_t j = 0; j < suit.joints(); ++j) {
        if (suit.joint_names[j] == joint) return suit.rest_offsets[j].norm();
      }
      return 0.0;
    };
    CHECK(leg_length(*own) == doctest::Approx(length("LeftLeg") + length("LeftFoot")));
    const auto own_length = [&](std::string_view joint) {
      return own->rest_offsets[pose_joint_at(joint)].norm();
    };
    CHECK(own_length("lradius") == doctest::Approx(length("LeftForeArm")));
    CHECK(own_length("rwrist") + own_length("rhand") == doctest::Approx(length("RightHand")));
    for (std::size_t j = 1; j < body.joints(); ++j) {
      CHECK(own->rest_offsets[j].normalized().dot(body.rest_offsets[j].normalized()) ==
            doctest::Approx(1.0));
    }
  }
}

TEST_CASE("a skeleton that is no person's is refused") {
  Skeleton suit = perception_neuron(1.75, 3);
  suit.joint_names[1] = "Tail";
  const auto own = with_lengths_of(other_body(), suit);
  REQUIRE_FALSE(own);
  CHECK(to_string(own.error()) ==
        "expected a skeleton with the joints of a suit (LeftUpLeg) or of CMU (lfemur), found no "
        "joint RightUpLeg");
}
