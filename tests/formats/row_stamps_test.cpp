// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/row_stamps.h"

#include "tests/formats/reading.h"
#include "tests/seeds.h"

#include "kinalign/formats/held_rows.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace kinalign;

namespace {

constexpr std::int64_t second_ns = 1'000'000'000;
constexpr TimeScale in_ns{1, 0}, in_us{1'000, 0}, in_ms{1'000'000, 0}, in_s{second_ns, 0},
    in_ticks{100, 0}, in_net_ticks{100, year_1_s};

/// "1700000000.000000001" for a stamp in units of `unit_ns`, with all its digits.
std::string written(std::int64_t ns, std::int64_t unit_ns) {
  const std::int64_t size = ns < 0 ? -ns : ns;
  std::string fraction = std::to_string(unit_ns + size % unit_ns).substr(1);  // with leading zeros
  return (ns < 0 ? "-" : "") + std::to_string(size / unit_ns) + "." + fraction;
}

/// The stamps of a file with these texts in its time column.
std::vector<std::int64_t> stamps_of(RowStamps stamps, const std::vector<std::int64_t>& column) {
  HeldRows<PointFrames> held;
  PointFrames out;
  for (const std::int64_t ns : column) {
    PointFrames& target = held.target(stamps, out);
    const auto stamp = stamps.next(ns);
    REQUIRE(stamp);
    target.stamps.push_back(*stamp);
    held.release(stamps, out);
  }
  stamps.settle();
  held.release(stamps, out);
  std::vector<std::int64_t> all;
  for (const Time stamp : out.stamps) all.push_back(to_ns(stamp));
  return all;
}

using Stamps = std::vector<std::int64_t>;

}  // namespace

TEST_CASE("stamps are read to the nanosecond") {
  CHECK(parse_stamp("1642700848.123456789", in_s) == 1'642'700'848'123'456'789);
  CHECK(parse_stamp("-0.5", in_s) == -500'000'000);
  CHECK(parse_stamp(".25", in_s) == 250'000'000);
  CHECK(parse_stamp("1e-3", in_s) == 1'000'000);
  CHECK(parse_stamp("0.0000000005", in_s) == 1);
  CHECK(parse_stamp("63562205247984", {1'000'000, year_1_s}) == 1'426'608'447'984'000'000);
  CHECK(parse_stamp("31867373716", in_ticks) == 3'186'737'371'600);
  CHECK_FALSE(parse_stamp("", in_s));
  CHECK_FALSE(parse_stamp("nan", in_s));
  CHECK_FALSE(parse_stamp(".", in_s));
  CHECK_FALSE(parse_stamp("12 13", in_s));
  CHECK_FALSE(parse_stamp("4000000001", in_s));
}

TEST_CASE("every stamp comes back to the nanosecond from its digits, in any unit") {
  for (const std::uint64_t seed : fresh_seeds(500)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto ns = static_cast<std::int64_t>(random() >> (1 + random() % 40)) % largest_stamp_ns;
    const std::int64_t stamp = random() % 2 == 0 ? ns : -ns;
    for (const TimeScale scale : {in_us, in_ms, in_s, in_ticks}) {
      const std::string text = written(stamp, scale.unit_ns);
      CAPTURE(text);
      CHECK(parse_stamp(text, scale) == stamp);
    }
    CHECK(parse_stamp(std::to_string(stamp), in_ns) == stamp);
  }
}

TEST_CASE("a tick of .NET is 100 ns, counted from the year 1") {
  // Python 3.11: (datetime(2024, 2, 29, 12) - datetime(1, 1, 1)) // timedelta(microseconds=1) * 10
  CHECK(parse_stamp("638448048000000000", in_net_ticks) == 1'709'208'000'000'000'000);
  CHECK(parse_stamp("638448048000000001", in_net_ticks) == 1'709'208'000'000'000'100);
  CHECK(parse_stamp("621355968000000000", in_net_ticks) == 0);
}

TEST_CASE("stamps reach 4e18 ns either way and no further") {
  CHECK(parse_stamp("4000000000000000000", in_ns) == largest_stamp_ns);
  CHECK(parse_stamp("-4000000000000000000", in_ns) == -largest_stamp_ns);
  CHECK_FALSE(parse_stamp("4000000000000000001", in_ns));
  CHECK_FALSE(parse_stamp("-4000000000000000001", in_ns));
  CHECK(parse_stamp("4000000000", in_s) == largest_stamp_ns);
  CHECK_FALSE(parse_stamp("4000000001", in_s));
  CHECK_FALSE(parse_stamp("-1e300", in_s));
  CHECK_FALSE(parse_stamp("0", {1, 10 * second_ns}));
  // Too many nanoseconds since the year 1 for 64 bits.
  CHECK_FALSE(parse_stamp("0", {1, year_1_s}));
  CHECK_FALSE(parse_stamp("9223372036854775799", in_net_ticks));
  CHECK_FALSE(parse_stamp("-9223372036854775799", in_net_ticks));
}

TEST_CASE("a stamp is a number and nothing else") {
  for (const std::string_view text : {"", "-", "+", ".", "-.", "1.2.3", "12:30", "1e", "nan", "inf",
                                      "0x10", "noon", "1 2", "1_000"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_stamp(text, in_s));
  }
  CHECK(parse_stamp("+1.5", in_s) == 1'500'000'000);
  CHECK(parse_stamp("1.", in_s) == second_ns);
  CHECK(parse_stamp("1,5e0", in_s) == 1'500'000'000);  // a decimal comma, as in a French locale
}

TEST_CASE("a rate's stamps do not drift: an hour of 29.97 Hz ends where it should") {
  CHECK(stamp_at_rate(0, 29.97) == 0);
  CHECK(stamp_at_rate(107'892, 29.97) == 3600 * second_ns);
  CHECK(stamp_at_rate(1, 30.0) == 33'333'333);
  CHECK(stamp_at_rate(2, 30.0) == 66'666'667);
  CHECK(stamp_at_rate(3, 30.0) == 100'000'000);
}

TEST_CASE("start_ns moves every stamp so that the first row has it") {
  CHECK(stamps_of(RowStamps(true, 0, 1000), {50, 60, 55}) == Stamps{1000, 1010, 1005});
  CHECK(stamps_of(RowStamps(true, 0, {}), {50, 60, 55}) == Stamps{50, 60, 55});
  CHECK(stamps_of(RowStamps(false, 10, -5), {0, 0, 0}) == Stamps{-5, 99'999'995, 199'999'995});
}

TEST_CASE("a column counts as stuck behind 32 equal stamps, or at the end of three") {
  struct Case {
    std::size_t equal, behind;
    bool stuck;
  };
  for (const Case& one :
       {Case{1, 0, false}, Case{2, 0, false}, Case{3, 0, true}, Case{31, 1, false},
        Case{32, 0, true}, Case{32, 1, true}, Case{500, 0, true}}) {
    CAPTURE(one.equal);
    CAPTURE(one.behind);
    RowStamps stamps(true, 0, {});
    for (std::size_t i = 0; i < one.equal; ++i) REQUIRE(stamps.next(7));
    for (std::size_t i = 0; i < one.behind; ++i) REQUIRE(stamps.next(8));
    stamps.settle();
    CHECK(stamps.stuck() == one.stuck);
    CHECK(stamps.rows() == one.equal + one.behind);
  }
}

TEST_CASE(
    "rows of a stuck column come at the rate, the ones held back too; without one they stay") {
  for (const std::size_t rows : {std::size_t{3}, std::size_t{32}, std::size_t{100}}) {
    CAPTURE(rows);
    const auto at_rate = stamps_of(RowStamps(true, 100, {}), Stamps(rows, 7));
    REQUIRE(at_rate.size() == rows);
    for (std::size_t i = 0; i < rows; ++i) {
      CHECK(at_rate[i] == 7 + static_cast<std::int64_t>(i) * 10'000'000);
    }
    CHECK(stamps_of(RowStamps(true, 0, {}), Stamps(rows, 7)) == Stamps(rows, 7));
  }
  CHECK(stamps_of(RowStamps(true, 100, 1'000), Stamps(4, 7)) ==
        Stamps{1'000, 10'001'000, 20'001'000, 30'001'000});
}

TEST_CASE("a changing time column keeps its stamps, whatever rate is given") {
  CHECK(stamps_of(RowStamps(true, 100, {}), {7, 7, 8, 8, 8}) == Stamps{7, 7, 8, 8, 8});
}

TEST_CASE("a constant time column is reported with the effect on the rows") {
  const auto said = [](double rate_hz, std::size_t rows) {
    RowStamps stamps(true, rate_hz, {});
    for (std::size_t i = 0; i < rows; ++i) REQUIRE(stamps.next(7));
    stamps.settle();
    return stuck_finding("k.csv", stamps);
  };
  const Finding lost = said(0, 40);
  CHECK(lost.severity == Severity::warning);
  CHECK(text_of(lost) ==
        "k.csv: expected stamps that change, found the same stamp in the first 32 rows");
  CHECK(lost.meaning == "the rows have no known time");
  CHECK(lost.repair == "set rate_hz to the rate of the device");
  const Finding mended = said(30, 5);
  CHECK(text_of(mended) ==
        "k.csv: expected stamps that change, found the same stamp in the first 5 rows");
  CHECK(mended.meaning == "the rows were stamped by rate_hz");
  CHECK(mended.repair == "");
}

TEST_CASE("a stamp that start_ns moves beyond time is an error, not another stamp") {
  RowStamps stamps(true, 0, largest_stamp_ns);
  REQUIRE(stamps.next(-largest_stamp_ns));
  const auto beyond = stamps.next(largest_stamp_ns);
  REQUIRE_FALSE(beyond);
  CHECK(to_string(beyond.error()) ==
        "expected a stamp inside +-4e18 ns, found 4000000000000000000 ns");
}

TEST_CASE("seconds are written exactly and read again to the same nanosecond") {
  CHECK(seconds_text(0) == "0");
  CHECK(seconds_text(10'000'000) == "0.01");
  CHECK(seconds_text(-1) == "-0.000000001");
  CHECK(seconds_text(12'000'000'000) == "12");
  CHECK(seconds_text(1'790'000'000'016'666'667) == "1790000000.016666667");
  constexpr TimeScale in_seconds{1'000'000'000, 0};
  for (const std::uint64_t seed : fresh_seeds(1000)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto ns = static_cast<std::int64_t>(random() >> (1 + random() % 60)) % largest_stamp_ns;
    CHECK(parse_stamp(seconds_text(ns), in_seconds) == ns);
    CHECK(parse_stamp(seconds_text(-ns), in_seconds) == -ns);
  }
}
