// SPDX-License-Identifier: Apache-2.0
#include "tests/formats/reading.h"
#include "tests/formats/written_text.h"
#include "tests/seeds.h"
#include "tests/shared_data.h"

#include "kinalign/formats/imu/opensim_sto.h"

#include <doctest/doctest.h>

#include <random>
#include <string>

using namespace kinalign;

namespace {

Result<std::string> sto_of(const ImuStream& stream, double rate_hz, Time zero = {}) {
  return written_text([&](TextOut& out) -> Result<void> {
    auto writer =
        KA_TRY(OpensimStoWriter::begin({stream.node_names, stream.content, rate_hz, zero}, out));
    return writer.append(stream.samples);
  });
}

std::string refusal(const ImuStream& stream, double rate_hz = 100.0) {
  const auto text = sto_of(stream, rate_hz);
  return text ? "" : to_string(text.error());
}

Read<ImuReader> read_again(std::string_view text) {
  return read_in_pieces(make_opensim_sto_reader({}, "written.sto"), text, 1009);
}

/// The largest angle between the orientations of valid samples, rad.
double largest_turn(const ImuSamples& a, const ImuSamples& b) {
  if (a.orientation.size() != b.orientation.size()) return HUGE_VAL;
  double most = 0.0;
  for (std::size_t i = 0; i < a.valid.size(); ++i) {
    if (a.valid[i] == 0) continue;
    most = std::max(most, quat(a.orientation, i).angularDistance(quat(b.orientation, i)));
  }
  return most;
}

ImuStream any_nodes(std::size_t nodes, std::size_t samples, std::mt19937_64& random) {
  std::normal_distribution<double> any;
  ImuStream out{{}, {.orientation = true}, {}};
  for (std::size_t s = 0; s < nodes; ++s)
    out.node_names.push_back("body" + std::to_string(s) + "_imu");
  for (std::size_t t = 0; t < samples; ++t) {
    out.samples.stamps.push_back(utc_time(16'666'667 * static_cast<std::int64_t>(t)));
    for (std::size_t s = 0; s < nodes; ++s) {
      const bool valid = random() % 7 != 0;
      const Quat q = Quat(any(random), any(random), any(random), any(random)).normalized();
      out.samples.valid.push_back(valid ? 1 : 0);
      for (const double part : {q.w(), q.x(), q.y(), q.z()}) {
        out.samples.orientation.push_back(valid ? part : 0.0);
      }
    }
  }
  return out;
}

}  // namespace

TEST_CASE("a .sto is written with rate and type, z up, four nan where a sample is not valid") {
  ImuStream stream{{"pelvis_imu", "torso_imu"}, {.orientation = true}, {}};
  stream.samples.stamps = {utc_time(1'000'000'000), utc_time(1'025'000'000)};
  const double half = std::sqrt(0.5);
  // Space y up: a sensor whose z points up, then one that lies as our space does.
  stream.samples.orientation = {half, -half, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, half, -half, 0, 0};
  stream.samples.valid = {1, 1, 0, 1};
  CHECK(sto_of(stream, 40.0, utc_time(1'000'000'000)).value() ==
        "DataRate=40.000000\nDataType=Quaternion\nversion=3\nOpenSimVersion=4.1\nendheader\n"
        "time\tpelvis_imu\ttorso_imu\n"
        "0\t1.000000000,0.000000000,0.000000000,0.000000000\t"
        "0.707106781,0.707106781,0.000000000,0.000000000\n"
        "0.025\tnan,nan,nan,nan\t1.000000000,0.000000000,0.000000000,0.000000000\n");
}

TEST_CASE("orientations that were written as .sto are read again to 2e-9 rad, stamps exactly") {
  for (const std::uint64_t seed : fresh_seeds(30)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const ImuStream stream = any_nodes(1 + random() % 10, 2 + random() % 40, random);
    const auto read = read_again(sto_of(stream, 60.0).value());
    CHECK(read.error == "");
    CHECK(read.findings.empty());
    CHECK(read.header.node_names == stream.node_names);
    CHECK(read.rows.stamps == stream.samples.stamps);
    CHECK(read.rows.valid == stream.samples.valid);
    CHECK(largest_turn(stream.samples, read.rows) <= 2e-9);
  }
}

TEST_CASE("a real .sto is written again with the same orientations" *
          doctest::skip(!shared_data())) {
  const auto first = read_again(shared_text(
      "imu_opensim/opensense/MT_012005D6_009-quaternions_calibration_trial_Facing_negX.sto"));
  REQUIRE(first.error == "");
  const ImuStream stream{first.header.node_names, first.header.content, first.rows};
  const auto again = read_again(sto_of(stream, 100.0).value());
  CHECK(again.rows.stamps == first.rows.stamps);
  CHECK(largest_turn(first.rows, again.rows) <= 2e-9);
}

TEST_CASE("what a .sto can't hold is refused") {
  std::mt19937_64 random(1);
  ImuStream stream = any_nodes(2, 3, random);
  CHECK(refusal(stream, 0.0) == "expected a rate for a .sto, found 0");
  stream.node_names[1] = "left\tarm";
  CHECK(refusal(stream) == "expected names of nodes for a .sto without tabs, found left?arm");
  stream.node_names.clear();
  CHECK(refusal(stream) == "expected at least one node for a .sto, found none");
  stream.content.orientation = false;
  CHECK(refusal(stream) == "expected orientations for a .sto, found nodes without orientations");
}
