// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/message_numbers.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <iterator>
#include <random>
#include <set>

using namespace kinalign;

namespace {

using Numbers = std::set<std::uint32_t>;

McapMessage numbered(std::uint32_t number, std::uint16_t channel = 7) {
  return {channel, number, 0, 0, {}};
}

/// Some random numbers near the beginning or the end of the range of 32 bits.
Numbers some(std::mt19937_64& random) {
  Numbers numbers;
  const std::uint32_t base = random() % 2 == 0 ? 0 : UINT32_MAX - 20;
  for (std::size_t k = random() % 15; k > 0; --k) {
    numbers.insert(base + static_cast<std::uint32_t>(random() % 21));
  }
  return numbers;
}

MessageNumbers of(const Numbers& numbers, std::mt19937_64& random) {
  std::vector<std::uint32_t> shuffled(numbers.begin(), numbers.end());
  std::shuffle(shuffled.begin(), shuffled.end(), random);
  MessageNumbers all;
  for (const std::uint32_t number : shuffled) all.add(numbered(number));
  return all;
}

}  // namespace

TEST_CASE("the numbers of messages are a set") {
  for (const auto seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Numbers a = some(random), b = some(random);
    const MessageNumbers ours = of(a, random), theirs = of(b, random);
    Numbers both, all;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::inserter(both, both.end()));
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::inserter(all, all.end()));
    CHECK(ours.present(7) == a.size());
    CHECK(ours.missing(7) ==
          (a.empty() ? 0 : std::uint64_t{*a.rbegin()} - *a.begin() + 1 - a.size()));
    CHECK(ours.has_all(theirs) == std::includes(a.begin(), a.end(), b.begin(), b.end()));
    CHECK(ours.shares_with(theirs, 7) == !both.empty());
    const bool goes_on =
        !a.empty() && std::includes(a.begin(), a.end(), b.lower_bound(*a.begin()), b.end());
    CHECK(ours.goes_on_with(theirs, 7) == goes_on);
    MessageNumbers joined = ours;
    joined.add_all(theirs);
    CHECK(joined.present(7) == all.size());
    for (std::uint32_t k = 0; k < 22; ++k) {
      for (const std::uint32_t number : {k, UINT32_MAX - k}) {
        CHECK(ours.has(numbered(number)) == a.contains(number));
        const auto next = a.lower_bound(number);
        CHECK(ours.next(7, number) == (next == a.end() ? std::nullopt : std::optional(*next)));
      }
    }
    CHECK_FALSE(ours.next(7, std::uint64_t{UINT32_MAX} + 1));
    CHECK(ours.present(8) == 0);
  }
}

TEST_CASE("each channel has numbers of its own") {
  MessageNumbers ours, theirs;
  ours.add(numbered(3, 1));
  ours.add(numbered(4, 2));
  theirs.add(numbered(3, 1));
  CHECK(ours.has_all(theirs));
  CHECK_FALSE(theirs.has_all(ours));
  CHECK_FALSE(ours.has(numbered(4, 1)));
  theirs.add(numbered(4, 1));
  CHECK_FALSE(ours.has_all(theirs));
  CHECK_FALSE(theirs.shares_with(ours, 2));
  ours.add_all(theirs);
  CHECK(ours.channels() == std::vector<std::uint16_t>{1, 2});
  CHECK(ours.present(1) == 2);
  CHECK(ours.present(2) == 1);
}

TEST_CASE("of what no checksum covers a number is believed that can be in the time between") {
  NumberGuard guard;
  const auto after = [](std::uint64_t seconds, std::uint32_t number) {
    McapMessage message = numbered(number);
    message.log_time = 1'000'000'000 * (1000 + seconds);
    return message;
  };
  CHECK(guard.believes(after(0, 1'000'000'000), true));  // nothing is known of the channel yet
  for (const std::uint32_t number : {5U, 6U, 900U}) CHECK(guard.believes(after(0, number), false));
  for (const std::uint32_t number : {901U, 950U, 902U, 900U + 1024U, 7U, 899U}) {
    CHECK(guard.believes(after(0, number), true));  // each is compared only with the checked ones
  }
  CHECK(guard.believes(after(1, 60'000), true));
  CHECK(guard.believes(after(3600, 3600 * 60'000), true));  // the disk stood still for an hour
  CHECK(guard.strays() == 0);
  for (const std::uint32_t number : {0U, 4U, 5U, 6U, 900U, 901U + 1024U, UINT32_MAX}) {
    CHECK_FALSE(guard.believes(after(0, number), true));
  }
  CHECK_FALSE(guard.believes(after(1, 70'000), true));
  CHECK_FALSE(guard.believes(numbered(70'000), true));  // the time of this message is wrong, too
  CHECK(guard.strays() == 9);
  CHECK(guard.believes(numbered(0, 8), true));
  // A message with a valid checksum is believed, whatever its number.
  CHECK(guard.believes(numbered(5), false));
}
