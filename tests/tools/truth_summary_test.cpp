// SPDX-License-Identifier: Apache-2.0
#include "tools/truth_table/summary.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

/// The truth that a live rehearsal of 4 s over link C leaves.
TrueRecording live_truth() {
  TrueRecording truth;
  truth.seed = 2;
  truth.motion = "built-in";
  truth.length_s = 4.0;
  truth.host = TrueHost{};
  truth.link = "C";
  truth.mocap.stream = "mocap";
  truth.kinect.stream = "kinect";
  truth.nodes.resize(2);
  for (TrueNode& node : truth.nodes) node.stream = "imu";
  return truth;
}

/// A device whose stamps have no interval.
TimeJudgement late(const std::string& stream, std::uint64_t samples, double by_s) {
  return {stream, "", samples, by_s, by_s, by_s, std::nullopt, 0, 0};
}

TimeJudgement certified(const std::string& stream, const std::string& node, std::uint64_t samples,
                        double worst_s, double half_width_s) {
  return {stream, node, samples, 0.0, worst_s, worst_s, half_width_s, samples, 0};
}

std::vector<TimeJudgement> live_times() {
  return {late("mocap", 1139, 0.0021), late("kinect", 598, 0.0020),
          certified("imu", "waist", 1967, 0.000092, 0.0048),
          certified("imu", "wrist", 1970, 0.000257, 0.0042)};
}

std::vector<ValueJudgement> live_values() {
  return {{"mocap", "", 1139, std::nullopt, 0.0016, std::nullopt},
          {"kinect", "", 598, 3.25, 0.098, 0.097},
          {"imu", "waist", 1139, std::nullopt, 0.0068, 0.0067},
          {"imu", "all nodes", 2278, std::nullopt, 0.0127, 0.0126}};
}

}  // namespace

TEST_CASE("the summary of a live rehearsal names the worst node and the Kinect's own noise") {
  const TrueRecording truth = live_truth();
  CHECK(
      summary({truth, live_times(), live_values()}) ==
      "simulated  4 s of a person who holds a T-pose, recorded by a suit, a Kinect and 2 nodes\n"
      "recorded   live over loopback and a simulated radio (link C): 1,139 suit frames, 598 Kinect "
      "frames and 3,937 node samples\n"
      "time       nodes ± 4.8 ms guaranteed, 0.26 ms at most in fact; Kinect 2.0 ms late (the "
      "least its sender takes)\n"
      "space      Kinect 9.8 cm from the truth; its own noise alone is 9.7 cm; suit 0.2 cm\n"
      "turning    nodes 0.73°/s from the truth; their own noise alone is 0.72°/s\n");
}

TEST_CASE("the summary says how many stamps are outside their interval") {
  const TrueRecording truth = live_truth();
  auto times = live_times();
  times[3].outside = 12;
  times[3].worst_s = 0.0061;
  const std::string text = summary({truth, times, live_values()});
  CHECK(text.find(
            "nodes ± 4.8 ms guaranteed, WRONG for 12 of 3,937 samples, the worst 6.1 ms off;") !=
        std::string::npos);
}

TEST_CASE("the summary of files that a Kinect alone wrote has no nodes and no radio") {
  TrueRecording truth = live_truth();
  truth.motion = "walk.bvh";
  truth.host.reset();
  truth.link.clear();
  truth.nodes.clear();
  const std::vector<TimeJudgement> times{certified("kinect", "", 598, 0.0001, 0.0005)};
  CHECK(summary({truth, times, {}}) ==
        "simulated  4 s of walk.bvh, recorded by a Kinect\n"
        "recorded   as files: 598 Kinect frames\n"
        "time       Kinect ± 0.50 ms guaranteed, 0.10 ms at most in fact\n");
}
