// SPDX-License-Identifier: Apache-2.0
#include "kinalign/wire/counter.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <array>
#include <limits>
#include <set>

namespace kinalign {

using Place = Counter::Place;

TEST_CASE("a number is unwrapped to the value nearest to the expected one") {
  constexpr std::int64_t turn = std::int64_t{1} << 32;
  CHECK(unwrapped(5, 32, turn) == turn + 5);
  CHECK(unwrapped(turn - 5, 32, turn) == turn - 5);
  CHECK(unwrapped(65'535, 16, 0) == -1);
  CHECK(unwrapped(1, 8, 1000) == 1025);
  CHECK(unwrapped(~std::uint64_t{0}, 64, 3) == -1);
  for (const auto seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto bits = static_cast<unsigned>(1 + random() % 60);
    const std::int64_t half = std::int64_t{1} << (bits - 1);
    const auto expected = static_cast<std::int64_t>(random() >> 2);
    const std::int64_t steps =
        static_cast<std::int64_t>(random() % (std::uint64_t{1} << bits)) - half;
    const auto sent = static_cast<std::uint64_t>(expected + steps);
    CHECK(unwrapped(sent, bits, expected) == expected + steps);
    // The bits above are ignored.
    CHECK(unwrapped(sent + (random() << bits), bits, expected) == expected + steps);
    CHECK(steps_between(static_cast<std::uint64_t>(expected), sent, bits) == steps);
  }
}

TEST_CASE("a counter takes each number of the last 1024 once") {
  Counter counter;
  CHECK(counter.empty());
  CHECK(counter.missing() == 0);
  CHECK(counter.place_of(counter.unwrap(0x9000'0005)) == Place::ahead);
  CHECK(counter.unwrap(0x9000'0005) == 0x9000'0005);  // the first number is not negative
  counter.take(5);
  CHECK(counter.place_of(5) == Place::duplicate);
  counter.take(1028);
  CHECK(counter.missing() == 1022);
  CHECK(counter.place_of(5) == Place::duplicate);
  CHECK(counter.place_of(6) == Place::late);
  CHECK(counter.place_of(4) == Place::behind);
  counter.take(4000);
  CHECK(counter.place_of(1028) == Place::behind);
  CHECK(counter.place_of(2977) == Place::late);
  CHECK(counter.place_of(2976) == Place::behind);
}

TEST_CASE("a counter agrees with a set of all numbers, for any number of bits and across wraps") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const unsigned bits = std::array{14U, 16U, 32U, 48U, 64U}[random() % 5];
    // The numbers begin just below a wrap.
    std::int64_t newest = (bits == 64 ? 0 : std::int64_t{1} << bits) - 2000;
    const auto sent = [bits](std::int64_t number) {
      return static_cast<std::uint64_t>(number) & (~std::uint64_t{0} >> (64 - bits));
    };
    Counter counter;
    counter.take(newest);
    std::set<std::int64_t> taken{newest};
    for (int i = 0; i < 5000; ++i) {
      const bool far = random() % 500 == 0;
      const std::int64_t number = newest - 1100 + static_cast<std::int64_t>(random() % 1110) +
                                  (far ? static_cast<std::int64_t>(random() % 2500) : 0);
      const Place expected = number > newest           ? Place::ahead
                             : number <= newest - 1024 ? Place::behind
                             : taken.contains(number)  ? Place::duplicate
                                                       : Place::late;
      REQUIRE(counter.unwrap(sent(number), bits) == number);
      REQUIRE(counter.place_of(number) == expected);
      REQUIRE(counter.steps_to(number) == number - newest);
      if (expected == Place::duplicate || expected == Place::behind) continue;
      counter.take(number);
      taken.insert(number);
      newest = *taken.rbegin();
      REQUIRE(counter.newest() == newest);
      REQUIRE(counter.first() == *taken.begin());
      REQUIRE(counter.missing() ==
              static_cast<std::uint64_t>(newest - *taken.begin() + 1) - taken.size());
    }
  }
}

TEST_CASE("numbers of 64 bits pass the largest signed value") {
  constexpr auto largest = std::numeric_limits<std::int64_t>::max();
  Counter counter;
  for (std::uint64_t k = 0; k < 3000; k += 2) {
    const std::int64_t number = counter.unwrap(static_cast<std::uint64_t>(largest) - 1000 + k, 64);
    REQUIRE(counter.place_of(number) == Place::ahead);
    counter.take(number);
  }
  CHECK(counter.newest() < 0);
  CHECK(counter.missing() == 1499);
  CHECK(counter.place_of(counter.newest() - 1) == Place::late);
}

}  // namespace kinalign
