// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/sequence_count.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <vector>

using namespace kinalign;

namespace {

SequenceCounts counts_of(const std::vector<std::uint64_t>& numbers, unsigned bits = 32) {
  SequenceCount count(bits);
  for (const auto number : numbers) count.push(number);
  return count.counts();
}

std::vector<std::uint64_t> range(std::uint64_t first, std::uint64_t count) {
  std::vector<std::uint64_t> numbers;
  for (std::uint64_t k = 0; k < count; ++k) numbers.push_back(first + k);
  return numbers;
}

std::vector<std::uint64_t> joined(std::vector<std::uint64_t> a,
                                  const std::vector<std::uint64_t>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

TEST_CASE("sequence: numbers in a row lose nothing, over a wrap too") {
  CHECK(counts_of(range(7, 100)) == SequenceCounts{100, 0, 0, 0, 0, 0});
  CHECK(counts_of(range(0xffffffc0, 100)) == SequenceCounts{100, 0, 0, 0, 0, 0});
  CHECK(counts_of(range(0xffc0, 100), 16) == SequenceCounts{100, 0, 0, 0, 0, 0});
  CHECK(counts_of(range(~std::uint64_t{0} - 9, 100), 64) == SequenceCounts{100, 0, 0, 0, 0, 0});
}

TEST_CASE("sequence: what lacks is lost until it comes, and then it was late") {
  SequenceCount count;
  CHECK(count.push(10) == Order::newest);
  CHECK(count.push(13) == Order::newest);
  CHECK(count.counts().lost == 2);
  CHECK(count.push(12) == Order::late);
  CHECK(count.counts() == SequenceCounts{3, 1, 1, 0, 0, 0});
  CHECK(count.push(12) == Order::duplicate);
  CHECK(count.push(13) == Order::duplicate);
  CHECK(count.counts() == SequenceCounts{5, 1, 1, 2, 0, 0});
}

TEST_CASE("sequence: the very first may have been overtaken too") {
  CHECK(counts_of({5, 4, 6}) == SequenceCounts{3, 0, 1, 0, 0, 0});
  CHECK(counts_of({5, 2, 6}) == SequenceCounts{3, 2, 1, 0, 0, 0});
}

TEST_CASE("sequence: a sender that begins anew far below or far above is one restart") {
  for (const std::uint64_t anew : {std::uint64_t{0}, std::uint64_t{3'000'000'000}}) {
    CHECK(counts_of(joined(range(500'000, 50), range(anew, 50))) ==
          SequenceCounts{100, 0, 0, 0, 1, 0});
  }
}

TEST_CASE("sequence: a sender that begins anew soon after is found by its run of old numbers") {
  CHECK(counts_of(joined(range(0, 500), range(0, 100))) == SequenceCounts{600, 0, 0, 0, 1, 0});
  CHECK(counts_of(joined(range(50, 500), range(0, 100))) == SequenceCounts{600, 0, 0, 0, 1, 0});
}

TEST_CASE("sequence: a network that doubles every packet shows no restart") {
  std::vector<std::uint64_t> numbers;
  for (std::uint64_t k = 0; k < 200; k += 8) {  // in bursts of eight
    for (int copy = 0; copy < 2; ++copy) numbers = joined(numbers, range(k, 8));
  }
  CHECK(counts_of(numbers) == SequenceCounts{400, 0, 0, 200, 0, 0});
}

TEST_CASE("sequence: one outlier costs nothing") {
  for (const std::uint64_t outlier : {0ULL, 5'000ULL, 90'000ULL, 4'000'000'000ULL}) {
    CAPTURE(outlier);
    CHECK(counts_of(joined(joined(range(50'000, 50), {outlier}), range(50'050, 50))) ==
          SequenceCounts{101, 0, 0, 0, 0, 1});
  }
}

TEST_CASE("sequence: a long loss is a loss where the count goes on behind it") {
  CHECK(counts_of(joined(range(0, 50), range(20'050, 50))) ==
        SequenceCounts{100, 20'000, 0, 0, 0, 0});
  CHECK(counts_of(joined(joined(range(0, 50), range(20'050, 50)), {20'049})) ==
        SequenceCounts{101, 19'999, 1, 0, 0, 0});
}

TEST_CASE("sequence: what is late behind a long loss is no duplicate of what was there before") {
  SequenceCount count;
  for (const auto number : range(0, 1000)) count.push(number);
  count.push(5'000);
  count.push(5'001);
  // 4071 and 999, the newest before the loss, share a bit of the window.
  CHECK(count.push(4'071) == Order::late);
  CHECK(count.counts() == SequenceCounts{1003, 3'999, 1, 0, 0, 0});
}

namespace {

/// Numbers in the order in which they arrive: each up to 30 places late, some twice, some never.
std::vector<std::pair<std::uint64_t, std::uint64_t>> on_the_air(std::uint64_t sent,
                                                                std::mt19937_64& random) {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> queue;
  for (std::uint64_t k = 0; k < sent; ++k) {
    if (k > 0 && k + 1 < sent && random() % 10 == 0) continue;
    const std::uint64_t copies = random() % 20 == 0 ? 2 : 1;
    for (std::uint64_t c = 0; c < copies; ++c) queue.emplace_back(k + random() % 30, k);
  }
  std::stable_sort(queue.begin(), queue.end(), [](auto& a, auto& b) { return a.first < b.first; });
  return queue;
}

}  // namespace

TEST_CASE("sequence: any loss, doubling and reordering is counted exactly") {
  for (const auto seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::uint64_t first = random() & 0xffffffff;
    const auto queue = on_the_air(2000, random);
    SequenceCount count;
    std::set<std::uint64_t> here;
    SequenceCounts truth;
    for (const auto& [place, k] : queue) {
      const bool doubled = here.count(k) != 0;
      if (doubled) ++truth.duplicates;
      if (!doubled && !here.empty() && k < *here.rbegin()) ++truth.late;
      here.insert(k);
      count.push(first + k);
      // The first arrival has overtaken at least eight, more than is believed.
      if (here.size() == 1 && k > 7) break;
    }
    if (here.size() == 1) continue;
    truth.received = queue.size();
    truth.lost = *here.rbegin() - *here.begin() + 1 - here.size();
    CHECK(count.counts() == truth);
  }
}

TEST_CASE("sequence: a packet's number goes on over a wrap, and begins again with a restart") {
  SequenceCount count;
  const auto place = [&count](std::uint64_t number) {
    count.push(number);
    return std::pair(count.place().run, count.place().number);
  };
  constexpr std::int64_t turn = std::int64_t{1} << 32;
  CHECK(place(0xffff'fffe) == std::pair(std::uint64_t{0}, turn - 2));
  CHECK(place(1) == std::pair(std::uint64_t{0}, turn + 1));
  CHECK(place(0xffff'ffff) == std::pair(std::uint64_t{0}, turn - 1));
  CHECK(place(5'000'000) == std::pair(std::uint64_t{1}, std::int64_t{5'000'000}));
  // The packet before was an outlier. No later packet shares its run.
  CHECK(place(2) == std::pair(std::uint64_t{2}, turn + 2));
  CHECK(place(3'000'000'000) == std::pair(std::uint64_t{3}, std::int64_t{3'000'000'000}));
  CHECK(place(3'000'000'001) == std::pair(std::uint64_t{3}, std::int64_t{3'000'000'001}));
}

TEST_CASE(
    "sequence: where there is no restart, what lies far behind was here and far ahead is an "
    "outlier") {
  SequenceCount count;
  for (const auto number : range(5'000, 100)) count.push(number, false);
  for (const auto number : range(5'000, 50)) {
    CHECK(count.push(number, false) == Order::duplicate);  // these numbers are in the window
  }
  for (const auto number : range(10, 50)) {
    CHECK(count.push(number, false) == Order::duplicate);  // from before the window
  }
  for (const auto number : range(2'000'000'000, 50)) {
    CHECK(count.push(number, false) == Order::outlier);
  }
  CHECK(count.push(5'102, false) == Order::newest);
  CHECK(count.counts() == SequenceCounts{251, 2, 0, 100, 0, 50});
}
