// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/live/live_fuser.h"

#include "tests/models/fuse/fuse_people.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

template <class T>
std::vector<T> part(const std::vector<T>& all, std::size_t first, std::size_t end,
                    std::size_t width) {
  return {all.begin() + static_cast<std::ptrdiff_t>(first * width),
          all.begin() + static_cast<std::ptrdiff_t>(end * width)};
}

FuseInput rows_of(const FuseInput& all, std::size_t first, std::size_t end) {
  const std::size_t nodes = all.nodes.nodes, joints = all.kinect.joints;
  return {{nodes, part(all.nodes.orientation, first, end, 4 * nodes),
           part(all.nodes.acceleration, first, end, 3 * nodes),
           part(all.nodes.angular_velocity, first, end, 3 * nodes),
           part(all.nodes.valid, first, end, nodes)},
          {joints, part(all.kinect.positions, first, end, 3 * joints),
           part(all.kinect.seen, first, end, joints)}};
}

}  // namespace

TEST_CASE("a live answer is that of the whole sequence with the headings as they were then") {
  constexpr std::size_t frames = 90;
  FusePerson person = fuse_person(frames);
  turn_heading(person.input.nodes, 0, 15.0);
  person.input.kinect.seen[60 * person.input.kinect.joints + 5] = 0;  // an elbow is lost
  for (std::size_t t = 65; t < 80; ++t) person.input.nodes.valid[t * 5 + 1] = 0;
  FuseModel model = random_fuse_model(3, false);
  model.smoothing = true;
  auto fuser = Fuser::make(std::move(model));
  REQUIRE(fuser);
  LiveFuser live(*fuser, 100);
  CHECK(live.look_ahead() == 1 + 4);  // the network, and smoothing of the root's position
  std::vector<FusedFramePose> found;
  std::vector<std::vector<HeadingState>> headings;
  for (std::size_t t = 0; t < frames; ++t) {
    live.add(rows_of(person.input, t, t + 1));
    live.answer(found);
    headings.resize(found.size(), live.headings());
  }
  REQUIRE(found.size() == frames - 5);
  const FuseLayout& layout = fuser->model().layout;
  std::optional<double> yaw;
  for (std::size_t end = 1; !yaw; ++end)
    yaw = shared_heading(layout, rows_of(person.input, 0, end));
  const std::size_t bones = layout.nodes.bones.size();
  for (std::size_t t = 45; t < found.size(); ++t) {  // earlier frames were answered at once
    CAPTURE(t);
    std::vector<HeadingState> all;
    for (std::size_t row = 0; row < t + 6; ++row) {
      const auto& then = headings[std::min(row, t)];
      all.insert(all.end(), then.begin(), then.end());
    }
    FuseInput seen = rows_of(person.input, 0, t + 6);
    turn_world(seen.nodes, *yaw);
    const FusedPose whole = fuser->solve(seen, all);
    CHECK((found[t].place - whole.place[t]).norm() < 1e-4F);
    CHECK((found[t].root.coeffs() - whole.root[t].coeffs()).norm() < 1e-5F);
    for (std::size_t b = 0; b < bones; ++b) {
      CHECK((found[t].rotations[b] - whole.rotations[t * bones + b]).norm() < 1e-4F);
    }
  }
}
