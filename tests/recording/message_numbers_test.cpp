// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/message_numbers.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <random>
#include <set>

using namespace kinalign;

namespace {

McapMessage numbered(std::uint32_t number, std::uint16_t channel = 7) {
  return {channel, number, 0, 0, {}};
}

}  // namespace

TEST_CASE("the numbers of messages are a set") {
  for (const auto seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::uint32_t base = random() % 2 == 0 ? 0 : UINT32_MAX - 20;
    std::set<std::uint32_t> numbers;
    MessageNumbers found;
    for (std::size_t k = random() % 25; k > 0; --k) {
      const std::uint32_t number = base + static_cast<std::uint32_t>(random() % 21);
      numbers.insert(number);
      found.add(numbered(number));
    }
    CHECK(found.missing(7) == (numbers.empty() ? 0
                                               : std::uint64_t{*numbers.rbegin()} -
                                                     *numbers.begin() + 1 - numbers.size()));
    CHECK(found.last(7) == (numbers.empty() ? std::nullopt : std::optional(*numbers.rbegin())));
    for (std::uint32_t k = 0; k < 22; ++k) {
      for (const std::uint32_t number : {k, UINT32_MAX - k}) {
        CHECK(found.has(numbered(number)) == numbers.contains(number));
        const auto next = numbers.lower_bound(number);
        CHECK(found.next(7, number) ==
              (next == numbers.end() ? std::nullopt : std::optional(*next)));
      }
    }
    CHECK_FALSE(found.next(7, std::uint64_t{UINT32_MAX} + 1));
  }
}

TEST_CASE("each channel has numbers of its own") {
  MessageNumbers numbers;
  for (const std::uint32_t number : {3U, 5U}) numbers.add(numbered(number, 1));
  for (const std::uint32_t number : {4U, 9U}) numbers.add(numbered(number, 2));
  CHECK_FALSE(numbers.has(numbered(4, 1)));
  CHECK(numbers.missing(1) == 1);
  CHECK(numbers.missing() == 1 + 4);
  CHECK(numbers.missing(3) == 0);
  CHECK_FALSE(numbers.last(3));
}
