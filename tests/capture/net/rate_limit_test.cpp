// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/rate_limit.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <vector>

using namespace kinalign;
using namespace std::chrono_literals;
using Verdict = RateLimit::Verdict;

namespace {

constexpr HostTime start{1h};

bool answered(RateLimit& limit, std::uint64_t hash, HostTime now) {
  return limit.ask(hash, now) == Verdict::answer;
}

/// A token bucket in its textbook form: tokens are added one by one.
class Bucket {
 public:
  bool ask(HostTime now) {
    tokens_ = std::min(8.0, tokens_ + seconds(now - last_) / 2.0);
    last_ = now;
    if (tokens_ < 1) return false;
    tokens_ -= 1;
    return true;
  }

 private:
  double tokens_ = 8;
  HostTime last_ = start;
};

}  // namespace

TEST_CASE("an unknown client gets eight answers at once, then one in two seconds") {
  RateLimit limit;
  for (int i = 0; i < 8; ++i) CHECK(answered(limit, 1, start));
  CHECK(!answered(limit, 1, start));
  CHECK(!answered(limit, 1, start + 1999ms));
  CHECK(answered(limit, 1, start + 2s));
  CHECK(!answered(limit, 1, start + 2s));
  for (int i = 0; i < 8; ++i) CHECK(answered(limit, 1, start + 60s));
  CHECK(!answered(limit, 1, start + 60s));
}

TEST_CASE("requests while refused do not prolong the refusal") {
  RateLimit limit;
  int answers = 0;
  for (int ms = 0; ms < 100'000; ++ms) {
    answers += answered(limit, 1, start + std::chrono::milliseconds(ms)) ? 1 : 0;
  }
  CHECK(answers == 8 + 49);
}

TEST_CASE("chrony's iburst and a poll every two seconds are never refused") {
  RateLimit limit;
  for (int i = 0; i < 1000; ++i) CHECK(answered(limit, 1, start + 2s * i));
}

TEST_CASE("law: the limit is the token bucket of the books, for any pattern of requests") {
  for (const auto seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    RateLimit limit;
    Bucket bucket;
    HostTime now = start;
    for (int i = 0; i < 300; ++i) {
      // Whole quarters of a second, so that the textbook's doubles are exact.
      now += 250ms * static_cast<int>(random() % (random() % 8 == 0 ? 60 : 6));
      REQUIRE(answered(limit, seed, now) == bucket.ask(now));
    }
  }
}

TEST_CASE("at most one refusal in 16 is a kiss of death") {
  RateLimit limit;
  int drops = 0, kisses = 0;
  for (int i = 0; i < 1608; ++i) {
    const Verdict verdict = limit.ask(7, start);
    drops += verdict == Verdict::drop ? 1 : 0;
    kisses += verdict == Verdict::kiss ? 1 : 0;
  }
  CHECK(kisses == 100);
  CHECK(drops == 1500);
}

TEST_CASE("strangers do not share a bucket, 10,000 of them neither") {
  RateLimit limit;
  std::mt19937_64 random(5);
  std::vector<std::uint64_t> hashes(10'000);
  for (auto& hash : hashes) hash = random();
  int refused = 0;
  for (int round = 0; round < 8; ++round) {
    for (const auto hash : hashes) refused += answered(limit, hash, start) ? 0 : 1;
  }
  CHECK(refused == 0);
  int answers = 0;
  for (const auto hash : hashes) answers += answered(limit, hash, start) ? 1 : 0;
  // 10,000 addresses in 16,384 sets of four: some 30 sets have five or more, and forget one.
  CHECK(answers <= 300);
}

TEST_CASE(
    "fault 28 flood_strangers: who is being refused stays refused under a flood of new addresses") {
  RateLimit limit;
  for (int i = 0; i < 8; ++i) CHECK(answered(limit, 42, start));
  std::mt19937_64 random(6);
  int answers = 0;
  for (int ms = 0; ms < 1000; ++ms) {
    const HostTime now = start + std::chrono::milliseconds(ms);
    for (int i = 0; i < 50; ++i) limit.ask(random(), now);
    answers += answered(limit, 42, now) ? 1 : 0;
  }
  CHECK(answers == 0);
}

TEST_CASE("fault 28 flood_strangers: 10,000 at 50,000 a second get eight each, and one in 2 s") {
  static_assert(RateLimit::entries == 65'536 && RateLimit::ways == 4);
  static_assert(RateLimit::burst == 8 && RateLimit::interval == 2s);
  RateLimit limit;
  std::mt19937_64 random(7);
  std::vector<std::uint64_t> hashes(10'000);
  for (auto& hash : hashes) hash = random();
  std::vector<int> answers(hashes.size());
  int kisses = 0, drops = 0;
  for (int packet = 0; packet < 500'000; ++packet) {
    const auto who = static_cast<std::size_t>(packet) % hashes.size();
    const Verdict verdict = limit.ask(hashes[who], start + 20us * packet);
    answers[who] += verdict == Verdict::answer ? 1 : 0;
    kisses += verdict == Verdict::kiss ? 1 : 0;
    drops += verdict == Verdict::drop ? 1 : 0;
  }
  // An address asks each 200 ms, 50 times: eight answers, and one more at 2, 4, 6 and 8 s.
  const auto as_stated = std::count(answers.begin(), answers.end(), 12);
  // Other addresses share their set of four with four more, and are forgotten.
  CHECK(as_stated > 9'900);
  CHECK(*std::min_element(answers.begin(), answers.end()) >= 12);
  CHECK(kisses * 16 <= kisses + drops);
}
