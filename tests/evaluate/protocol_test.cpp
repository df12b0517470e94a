// SPDX-License-Identifier: Apache-2.0
#include "kinalign/evaluate/protocol.h"

#include "tests/evaluate/moving_body.h"
#include "tests/seeds.h"
#include "tests/shared_data.h"
#include "tests/witness.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace kinalign;

namespace {

bool has_protocol() { return std::filesystem::exists(shared_path("../tools/ui_prmd_marks.py")); }

void check_near(std::optional<double> ours, double theirs) {
  REQUIRE(ours);
  CHECK(*ours == doctest::Approx(theirs).epsilon(1e-9));
}

}  // namespace

TEST_CASE("the marks are those of the protocol's script" * doctest::skip(!has_protocol())) {
  for (const auto seed : fresh_seeds(3)) {
    CAPTURE(seed);
    MovingBody body = moving_body(seed);
    for (std::size_t t = 3; t < 80; ++t) body.valid[18 * t + 9] = 0;  // seen three times: too rare
    for (std::size_t j = 0; j < 8; ++j) body.valid[18 * 40 + j] = 0;  // too few joints to fit
    const Sequence s = body.sequence();
    auto lengths = limb_lengths(std::span(&s, 1));
    lengths[2] = std::nullopt;
    std::vector<double> given;
    for (const auto& length : lengths) given.push_back(length.value_or(0.0));
    const auto found =
        run_python("ui_prmd_metrics.py", {{"truth", body.truth},
                                          {"prediction", body.prediction},
                                          {"valid", {body.valid.begin(), body.valid.end()}},
                                          {"lengths", given}});
    const ProtocolMarks ours = protocol_marks(s, body.prediction, lengths);
    const auto& marks = found.at("marks");
    check_near(ours.position_cm, marks[0]);
    check_near(ours.fitted_cm, marks[1]);
    check_near(ours.bone_cm, marks[2]);
    check_near(ours.constancy_cm, marks[3]);
    check_near(ours.acceleration_mm, marks[4]);
    check_near(ours.jitter_mm, marks[5]);
    check_near(ours.true_jitter_mm, marks[6]);
    ProtocolMarks shaky = ours;
    shaky.jitter_mm *= 2.0;
    const ProtocolMeans row = protocol_row(std::array{ours, shaky});
    check_near(row.position_cm, found.at("row")[0]);
    check_near(row.constancy_cm, found.at("row")[3]);
    check_near(row.jitter, found.at("row")[5]);
  }
}

TEST_CASE("the truth's row has the truth's own bones and jitter 1") {
  const MovingBody body = moving_body(1);
  const Sequence s = body.sequence();
  const ProtocolMarks marks = protocol_marks(s, body.truth, limb_lengths(std::span(&s, 1)));
  const ProtocolMeans row = protocol_row(std::array{marks});
  CHECK(row.position_cm == 0.0);
  CHECK(row.acceleration_mm == 0.0);
  CHECK(row.jitter == 1.0);
  CHECK(row.bone_cm.value() > 0.0);
}

TEST_CASE("a mark that a repetition lacks does not count in its fold") {
  ProtocolMarks with, without;
  with.position_cm = 4.0;
  with.fitted_cm = 3.0;
  with.true_jitter_mm = 1.0;
  with.jitter_mm = 2.0;
  without.position_cm = 6.0;
  const ProtocolMeans row = protocol_row(std::array{with, without});
  CHECK(row.position_cm == 5.0);
  CHECK(row.fitted_cm == 3.0);
  CHECK_FALSE(row.bone_cm);
  CHECK(row.jitter == 2.0);
  CHECK_FALSE(protocol_row({}).position_cm);
}
