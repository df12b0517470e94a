// SPDX-License-Identifier: Apache-2.0
#include "kinalign/documents/truth_json.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>

using namespace kinalign;

namespace {

TrueRecording some_truth() {
  TrueRecording truth;
  truth.seed = 18'000'000'000'000'000'000U;
  truth.motion = "built-in";
  truth.motion_file = "motion.bvh";
  truth.length_s = 60.5;
  truth.start_ns = 1'790'000'000'000'000'001;
  truth.host = TrueHost{5, 1'790'000'000'000'000'006};
  truth.link = "C";
  truth.mocap = {"mocap", 60.0, 3000, 1, 2, 3};
  truth.kinect = {"kinect", {Quat(0.5, 0.5, -0.5, 0.5), Vec3(1, 2.5, -3)}, -7.25, {{1, 2}, {3, 4}}};
  TrueNode node;
  node.stream = "imu";
  node.node = "waist";
  node.joint = "Hips";
  node.id = 4;
  node.offset = Vec3(0.1, 0.2, 0.3);
  node.bone_from_sensor = Quat(0, 1, 0, 0);
  node.sensor_delay_ms = 5;
  node.gyroscope_zero = Vec3(1e-3, 0, 0);
  node.clock = {{-5, 10}, {20, 30}};
  truth.nodes = {node};
  return truth;
}

std::string error_of(const std::string& text) {
  const auto truth = read_truth(text, "truth.json");
  return truth ? "none" : to_string(truth.error());
}

std::string without(const std::string& part, const std::string& instead) {
  std::string text = truth_json(some_truth());
  const auto at = text.find(part);
  REQUIRE(at != std::string::npos);
  return text.replace(at, part.size(), instead);
}

}  // namespace

TEST_CASE("a truth that is written is read again to the same text") {
  const std::string text = truth_json(some_truth());
  const auto read = read_truth(text, "truth.json");
  REQUIRE_MESSAGE(read, (read ? "" : to_string(read.error())));
  CHECK(truth_json(*read) == text);
  CHECK(read->seed == 18'000'000'000'000'000'000U);
  CHECK(read->host->utc_ns == 1'790'000'000'000'000'006);
  CHECK(read->kinect.world_from_kinect.translation == Vec3(1, 2.5, -3));
  CHECK(read->nodes.at(0).clock.stamps_ns == std::vector<std::int64_t>{-5, 10});
}

TEST_CASE("a truth that lacks a key, or has one of another kind, is refused by name") {
  CHECK(error_of("{").starts_with("truth.json: expected JSON as kinalign.truth/1 has it, found "));
  CHECK(error_of("[]").starts_with("truth.json: expected JSON as kinalign.truth/1 has it, found "));
  CHECK(error_of(without("kinalign.truth/1", "kinalign.take/1")) ==
        "truth.json: expected kinalign.truth/1, found kinalign.take/1");
  CHECK(error_of(without("\"drift_ppm\":-7.25,", "")).find("drift_ppm") != std::string::npos);
  CHECK(error_of(without("\"joint\":\"Hips\"", "\"joint\":3")) != "none");
  CHECK(
      error_of(without("[-5,10]", "[10,10]")) ==
      "truth.json: expected a clock of waist with a time for each of rising stamps, found another");
  CHECK(error_of(without("[-5,10]", "[-5,1,10]")) != "none");
  CHECK(error_of(without("[-5,10]", "[-5,2000000000000000001]")) ==
        "truth.json: expected stamps and times of waist within 2e18 ns, found others");
  CHECK(error_of(without("[-5,10]", "[-5,1.79e27]"))
            .starts_with(
                "truth.json: expected JSON as kinalign.truth/1 has it, found an integer in range"));
  CHECK(error_of(without("\"id\":4", "\"id\":4294967296")) != "none");
  CHECK(error_of(without("\"rate_hz\":60.0", "\"rate_hz\":0")) ==
        "truth.json: expected a mocap of 1 Hz to 1 MHz, 1e9 frames at the most, found "
        "another");
}

TEST_CASE("a truth that was damaged is read or refused, and no clock of it steps back") {
  for (const auto seed : fresh_seeds(1)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::string whole = truth_json(some_truth());
    for (int i = 0; i < 3000; ++i) {
      std::string text =
          whole.substr(0, random() % 4 == 0 ? random() % whole.size() : whole.size());
      for (std::uint64_t n = random() % 4; n > 0 && !text.empty(); --n) {
        text[random() % text.size()] = "0123456789-.eE[]{},:\"x\xc3"[random() % 22];
      }
      const auto read = read_truth(text, "truth.json");
      if (!read) continue;
      for (const TrueNode& node : read->nodes) {
        const auto& stamps = node.clock.stamps_ns;
        CHECK(std::is_sorted(stamps.begin(), stamps.end()));
        CHECK(stamps.size() == node.clock.times_ns.size());
        (void)true_time(node.clock, utc_time(17));
      }
      CHECK(truth_json(*read).size() > 100);
    }
  }
}
