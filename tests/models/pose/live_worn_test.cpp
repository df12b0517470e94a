// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/live_worn.h"

#include "tests/models/pose/pose_people.h"

#include "kinalign/motion/rotation.h"

#include <doctest/doctest.h>

#include <functional>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

constexpr std::size_t ankle = 2;  // index in test_layout()
const Time started = utc_time(1'790'000'000'000'000'000);

/// The movement of a node at one time, on a person who stands in a T-pose; absent: the node
/// sends nothing.
struct Doing {
  Quat slip = Quat::Identity();  // turn of the node against its limb
  Vec3 rate = Vec3::Zero();      // rad/s
};
using Play = std::function<std::optional<Doing>(std::size_t node, double s)>;

/// Ten seconds at 60 Hz of nodes worn as in docs/pose.md; a T-pose is marked at 6 s.
struct LiveRun {
  PoseLayout layout = test_layout();
  Skeleton body = pose_body(test_offsets()).skeleton;
  LiveWorn worn{layout, body, {}};
  std::vector<LiveWornFrame> frames;
  std::vector<std::string> refusals;

  explicit LiveRun(const Play& play) {
    for (int i = 0; i < 600; ++i) {
      const Time now = started + i * 1'000'000'000ns / 60;
      if (i == 360) worn.mark_t_pose(now);
      for (std::size_t n = 0; n < layout.nodes.size(); ++n) {
        const auto doing = play(n, seconds(now - started));
        if (!doing) continue;
        const Quat q = worn_in_t_pose(*worn_place(layout.nodes[n])) * doing->slip;
        worn.add(n, {now, now, q, q.conjugate() * Vec3(0.0, 9.80665, 0.0), doing->rate, true});
      }
      worn.advance(
          now, [](Time) { return true; }, frames);
      if (const auto why = worn.take_refusal()) refusals.push_back(*why);
    }
  }

  /// The angle of the left shank from its T-pose in a frame, rad.
  double shank_off(std::size_t frame) const {
    const std::vector<float>& all = frames.at(frame).nodes.orientation;
    const float* q = &all[4 * ankle];
    const Quat bone(static_cast<double>(q[0]), static_cast<double>(q[1]), static_cast<double>(q[2]),
                    static_cast<double>(q[3]));
    return bone.angularDistance((*t_pose_rotations(layout, body))[ankle]);
  }
};

const Quat slipped = rotation(Vec3(0.4, 0.0, 0.0));  // rad

/// The node on the left shank slips at 4.5 s.
Doing slips(std::size_t node, double s) {
  return {node == ankle && s >= 4.5 ? slipped : Quat::Identity(), Vec3::Zero()};
}

}  // namespace

TEST_CASE("a marked T-pose puts a node that has slipped onto its bone again") {
  const LiveRun run([](std::size_t node, double s) { return slips(node, s); });
  CHECK(run.refusals.empty());
  CHECK(run.worn.calibration()->first == 180);
  CHECK(run.worn.calibration()->count == 61);  // two seconds
  CHECK_FALSE(run.worn.calibration()->found);  // a mark stated it
  CHECK(run.shank_off(60) < 0.001);
  CHECK(run.shank_off(200) == doctest::Approx(0.4).epsilon(0.01));
  CHECK(run.shank_off(270) < 0.001);
}

TEST_CASE("a person who moves in a marked T-pose is refused, and the calibration before holds") {
  const LiveRun run([](std::size_t node, double s) {
    Doing out = slips(node, s);
    if (node == 0 && s > 7.0 && s < 7.5) out.rate.x() = 1.0;
    return out;
  });
  CHECK(run.refusals ==
        std::vector<std::string>{"a node turned at 57 deg/s: the person did not hold still"});
  CHECK(run.worn.calibration()->first == 0);
  CHECK(run.worn.calibration()->found);
  CHECK(run.shank_off(270) == doctest::Approx(0.4).epsilon(0.01));
}

TEST_CASE("an arm that hangs in a marked T-pose is refused") {
  const LiveRun run([](std::size_t node, double s) {
    Doing out = slips(node, s);
    if (node == 0 && s > 5.0) out.slip = rotation(Vec3(0.0, 1.4, 0.0));
    return out;
  });
  CHECK(run.refusals == std::vector<std::string>{"wrist_left is not in a T-pose"});
  CHECK(run.worn.calibration()->first == 0);
}

TEST_CASE("a node that is silent in a marked T-pose keeps its calibration") {
  const LiveRun run([](std::size_t node, double s) -> std::optional<Doing> {
    if (node == ankle && s > 5.5 && s < 8.5) return std::nullopt;
    return Doing{};
  });
  CHECK(run.refusals == std::vector<std::string>{"ankle_left has no samples in it"});
  CHECK(run.worn.calibration()->first == 0);
  CHECK(run.frames.at(280).nodes.valid[ankle] == 1);
}

TEST_CASE("two nodes are no T-pose") {
  const LiveRun run([](std::size_t node, double) -> std::optional<Doing> {
    if (node != 0 && node != 4) return std::nullopt;
    return Doing{};
  });
  REQUIRE(!run.refusals.empty());
  CHECK(run.refusals.front() == "fewer than three nodes have samples in it");
  CHECK(!run.worn.calibration());
}
