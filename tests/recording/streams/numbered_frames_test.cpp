// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/numbered_frames.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

/// Frames of three letters: a body, a digit of the number, and an end. The end "d" marks a
/// duplicate.
struct Letters {
  struct Arrival {
    std::string frame;
    SequencePlace place;
    Order order = Order::newest;
  };
  using Frame = std::string;
  struct Decoder {
    std::string held{};
    void feed(std::span<const std::uint8_t> bytes, std::vector<Arrival>& out) {
      held += text_of(bytes);
      for (; held.size() >= 3; held.erase(0, 3))
        out.push_back({held.substr(0, 3),
                       {0, held[1] - '0'},
                       held[2] == 'd' ? Order::duplicate : Order::newest});
    }
    Findings findings(const std::string& file) const {
      return {{Severity::note, Error{file, 0, "letters", "letters"}, "", ""}};
    }
  };
  static Frame* frame(Arrival& arrival) { return &arrival.frame; }
  static std::uint64_t body(const Arrival& arrival) {
    return static_cast<std::uint64_t>(arrival.frame[0]);
  }
};

}  // namespace

TEST_CASE("two connections that speak in turn have a decoder and a count each") {
  const RawChannel raw{"mocap", "letters", "tcp", "10.0.0.3:7012", "", ""};
  NumberedFrames<Letters> frames(std::nullopt);
  std::vector<NumberedFrames<Letters>::Placed> out;
  // Halves of frames from two senders; the second counts from another number.
  for (const auto& [channel, text] :
       {std::pair{1, "a1"}, {2, "a5."}, {1, ".a2.a"}, {2, "a6"}, {1, "3."}, {2, "."}}) {
    frames.take({&raw, static_cast<std::uint16_t>(channel), HostTime{}, text}, out);
  }
  REQUIRE(out.size() == 5);
  std::map<BootKey, std::vector<std::int64_t>> lives;
  for (const auto& one : out) {
    REQUIRE(one.place);
    lives[one.place->life].push_back(one.place->number);
  }
  REQUIRE(lives.size() == 2);
  CHECK(lives.begin()->second == std::vector<std::int64_t>{1, 2, 3});
  CHECK(lives.rbegin()->second == std::vector<std::int64_t>{5, 6});
  CHECK(frames.findings("take.mcap").size() == 1);  // the same finding for both senders
}

TEST_CASE("frames that repeat a number are left out and counted") {
  const RawChannel raw{"mocap", "letters", "udp", "10.0.0.3:7012", "", ""};
  NumberedFrames<Letters> frames(std::nullopt);
  std::vector<NumberedFrames<Letters>::Placed> out;
  frames.take({&raw, 1, HostTime{}, "a1.a2.a1da2da3."}, out);
  CHECK(out.size() == 3);
  const Findings findings = frames.findings("take.mcap");
  REQUIRE(findings.size() == 2);
  CHECK(to_string(findings[1].what) ==
        "take.mcap: expected each frame number once, found 2 frames that repeat an earlier number");
}

TEST_CASE("where all frames were refused the reason is named, not the port") {
  LearnedDevice learned;
  learned.channel.stream = "mocap";
  const Finding refused{Severity::note,
                        Error{"a.mcap", 0, "whole frames", "incomplete (238 times)"},
                        "frames were dropped", "use TCP"};
  CHECK(
      to_string(no_rows_error("frames", "a.mcap", learned, 0, {refused})) ==
      "a.mcap: expected frames in stream mocap (use TCP), found only refused ones: incomplete (238 "
      "times)");
}
