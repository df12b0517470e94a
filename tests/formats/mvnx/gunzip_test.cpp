// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/mvnx/gunzip.h"

#include "tests/formats/mvnx/gzip.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <string>

using namespace kinalign;

namespace {

struct Unpacked {
  std::string text, error;
  bool complete = false;
};

Unpacked unpacked(const std::string& bytes, std::size_t piece) {
  Unpacked out;
  Gunzip gunzip;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    const auto fed = gunzip.feed(std::string_view(bytes).substr(at, piece),
                                 [&](std::string_view more) -> Result<void> {
                                   out.text += more;
                                   return {};
                                 });
    if (!fed) {
      out.error = to_string(fed.error());
      break;
    }
  }
  out.complete = gunzip.complete();
  return out;
}

}  // namespace

TEST_CASE("a gzip archive is unpacked in pieces of any size") {
  for (const std::uint64_t seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::string text(random() % 300'000, ' ');
    for (char& c : text) c = static_cast<char>('a' + random() % 4);
    const std::string packed = gzip(text);
    CHECK(looks_like_gzip(packed));
    const auto found = unpacked(packed, 1 + random() % 5000);
    CHECK(found.error == "");
    CHECK(found.complete);
    CHECK(found.text == text);
  }
}

TEST_CASE("archives that stand one behind the other are one text") {
  CHECK(unpacked(gzip("first ") + gzip("second"), 3).text == "first second");
}

TEST_CASE("a cut archive is not complete, a damaged one is an error") {
  const std::string packed = gzip(std::string(5000, 'x') + "end");
  const auto cut = unpacked(packed.substr(0, packed.size() - 3), 10);
  CHECK(cut.error == "");
  CHECK(!cut.complete);
  std::string damaged = packed;
  // The checksum is damaged.
  damaged[damaged.size() - 6] = static_cast<char>(damaged[damaged.size() - 6] + 1);
  CHECK(unpacked(damaged, 10).error == "expected a whole gzip archive, found damaged bytes");
  CHECK(unpacked(packed + "rest", 1000).error ==
        "expected a whole gzip archive, found damaged bytes");
}

TEST_CASE("the text before damage is the same wherever the archive is cut") {
  for (const std::uint64_t seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::string text(2000, ' ');
    for (char& c : text) c = static_cast<char>('a' + random() % 20);
    std::string packed = gzip(text);
    packed[12 + random() % (packed.size() - 12)] ^= static_cast<char>(1 + random() % 255);
    const auto whole = unpacked(packed, packed.size());
    const auto cut = unpacked(packed, 1 + random() % 40);
    CHECK(cut.text == whole.text);
    CHECK(cut.error == whole.error);
  }
}
