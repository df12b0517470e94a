// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/fuse/fuse_draws.h"

#include "tests/models/fuse/fuse_people.h"

#include "kinalign/models/fuse/seen_bones.h"

#include <doctest/doctest.h>

#include <numeric>

using namespace kinalign;

namespace {

std::size_t count_of(const std::vector<std::uint8_t>& flags) {
  return static_cast<std::size_t>(
      std::count_if(flags.begin(), flags.end(), [](std::uint8_t flag) { return flag != 0; }));
}

}  // namespace

TEST_CASE("crops lack a device as often as stated, and never both") {
  const FuseLayout layout = fuse_test_layout();
  const FusePerson person = fuse_person(64);
  FuseDraws draws;
  draws.errors.lost_share = 0.0;
  draws.lost_part = 0.0;
  std::size_t without_kinect = 0, without_nodes = 0;
  for (std::uint64_t k = 0; k < 1000; ++k) {
    const FuseInput drawn = drawn_input(person.input, layout, draws, 1, k);
    const bool kinect = count_of(drawn.kinect.seen) > 0, nodes = count_of(drawn.nodes.valid) > 0;
    REQUIRE((kinect || nodes));
    if (!kinect) ++without_kinect;
    if (!nodes) ++without_nodes;
  }
  CHECK(without_kinect > 160);
  CHECK(without_kinect < 240);
  CHECK(without_nodes > 160);
  CHECK(without_nodes < 240);
}

TEST_CASE("a lost part is one limb or one node, for no longer than stated") {
  const FuseLayout layout = fuse_test_layout();
  const FusePerson person = fuse_person(120);
  FuseDraws draws;
  draws.errors.lost_share = draws.without_kinect = draws.without_nodes = 0.0;
  draws.lost_part = 1.0;
  draws.most_lost_s = 2.0;
  const std::size_t all_joints = person.input.kinect.seen.size(),
                    all = person.input.nodes.valid.size();
  bool some_limb = false, some_node = false;
  for (std::uint64_t k = 0; k < 200; ++k) {
    const FuseInput drawn = drawn_input(person.input, layout, draws, 1, k);
    const std::size_t joints = all_joints - count_of(drawn.kinect.seen);
    const std::size_t nodes = all - count_of(drawn.nodes.valid);
    CHECK((joints == 0 || nodes == 0));
    CHECK(joints <= 3 * 60);
    CHECK(nodes <= 60);
    some_limb = some_limb || joints > 0;
    some_node = some_node || nodes > 0;
  }
  CHECK(some_limb);
  CHECK(some_node);
}

TEST_CASE("the same number gives the same draw; a method of one device never sees the other") {
  const FuseLayout layout = fuse_test_layout();
  const FusePerson person = fuse_person(64);
  FuseDraws draws;
  CHECK(drawn_input(person.input, layout, draws, 1, 7).nodes.orientation ==
        drawn_input(person.input, layout, draws, 1, 7).nodes.orientation);
  CHECK(drawn_input(person.input, layout, draws, 1, 7).nodes.orientation !=
        drawn_input(person.input, layout, draws, 1, 8).nodes.orientation);
  draws.devices = Devices::kinect;
  CHECK(count_of(drawn_input(person.input, layout, draws, 1, 1).nodes.valid) == 0);
  draws.devices = Devices::nodes;
  CHECK(count_of(drawn_input(person.input, layout, draws, 1, 1).kinect.seen) == 0);
}

TEST_CASE("a Kinect that takes a back for a front is set right by the waist's node") {
  const FuseLayout layout = fuse_test_layout();
  FusePerson person = fuse_person(64);
  FuseInput exchanged = person.input;
  const auto partners = mirror_partners(layout.joints);
  for (std::size_t t = 0; t < 64; ++t) {
    for (std::size_t j = 0; j < partners.size(); ++j) {
      const std::size_t from = 3 * (t * partners.size() + partners[j]);
      std::copy_n(&person.input.kinect.positions[from], 3,
                  &exchanged.kinect.positions[3 * (t * partners.size() + j)]);
    }
  }
  CHECK(exchanged.kinect.positions != person.input.kinect.positions);
  unexchange(layout, exchanged);
  CHECK(exchanged.kinect.positions == person.input.kinect.positions);
  lose_all(person.input.nodes.valid);
  FuseInput alone{person.input.nodes, exchanged.kinect};
  unexchange(layout, alone);
  CHECK(alone.kinect.positions == exchanged.kinect.positions);
}
