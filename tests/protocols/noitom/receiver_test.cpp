// SPDX-License-Identifier: Apache-2.0
// Datagrams of the BVH broadcast that are lost, out of order or truncated.
#include "kinalign/protocols/noitom/receiver.h"

#include "tests/protocols/noitom/noitom_cases.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace kinalign;

namespace {

struct Datagram {
  Bytes bytes;
  std::int64_t at_us = 0;
};
using Datagrams = std::vector<Datagram>;

/// A frame whose values occur in no other frame.
NoitomFrame sent_frame(NoitomForm form, std::uint32_t index) {
  NoitomFrame frame = noitom_frame(form, true, false, index);
  for (std::size_t k = 0; k < frame.values.size(); ++k) {
    frame.values[k] = static_cast<float>(1000 * index + k);
  }
  return frame;
}

Bytes sent_bytes(std::uint32_t index, NoitomForm form = NoitomForm::new_header) {
  return bytes_of(sent_frame(form, index));
}

/// A frame each 8 ms with its pieces `gap_us` apart.
Datagrams sent(NoitomForm form, std::uint32_t frames, std::size_t pieces,
               std::int64_t gap_us = 100) {
  Datagrams all;
  for (std::uint32_t k = 0; k < frames; ++k) {
    const Bytes bytes = sent_bytes(k, form);
    for (std::size_t p = 0; p < pieces; ++p) {
      const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() * p / pieces);
      const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() * (p + 1) / pieces);
      all.push_back({Bytes(begin, end), 8000 * k + gap_us * static_cast<std::int64_t>(p)});
    }
  }
  return all;
}

/// Piece `piece` of frame `frame` of two pieces each.
Datagram half(std::uint32_t frame, std::size_t piece, NoitomForm form = NoitomForm::new_header) {
  return sent(form, frame + 1, 2)[2 * frame + piece];
}
Datagram head(std::uint32_t frame) { return half(frame, 0); }
Datagram tail(std::uint32_t frame) { return half(frame, 1); }

struct Received {
  std::vector<NoitomArrival> arrivals;
  NoitomCounts counts;
  std::uint64_t lost = 0;  // found by the numbers
  Findings findings;

  std::vector<std::uint32_t> indices() const {
    std::vector<std::uint32_t> all;
    for (const auto& one : arrivals) all.push_back(one.frame.frame_index.value_or(0));
    return all;
  }
};

Received receive(const Datagrams& datagrams) {
  NoitomReceiver receiver;
  Received received;
  for (const Datagram& one : datagrams) {
    receiver.feed_datagram(one.bytes, HostTime{std::chrono::microseconds(one.at_us)},
                           received.arrivals);
    CHECK(receiver.waiting() <= 20'480);
  }
  receiver.finish(received.arrivals);
  received.counts = receiver.counts();
  for (const auto& [index, avatar] : receiver.avatars())
    received.lost += avatar.by_index.counts().lost;
  received.findings = receiver.findings("axis");
  return received;
}

/// The number of received frames that were not sent: their values come from two frames.
std::size_t mixed(const Received& received) {
  std::size_t count = 0;
  for (const NoitomArrival& one : received.arrivals) {
    const auto index = static_cast<std::uint32_t>(one.frame.values.at(0) / 1000.0F);
    if (!(one.frame == sent_frame(one.frame.form, index))) ++count;
  }
  return count;
}

/// The datagrams without `percent` of them, each loss `in_a_row` long. The first frame stays.
Datagrams without(const Datagrams& all, unsigned percent, int in_a_row, std::mt19937_64& random) {
  Datagrams left;
  int losses = 0;
  for (const Datagram& one : all) {
    if (left.size() >= 2 && random() % 100 < percent) losses = in_a_row;
    if (losses-- <= 0) left.push_back(one);
  }
  return left;
}

/// Swaps `percent` of the datagrams with the next one, at most two swaps in a row.
void swap_some(Datagrams& all, unsigned percent, std::mt19937_64& random) {
  int running = 0;
  for (std::size_t i = 3; i < all.size(); ++i) {
    if (running >= 2 || random() % 100 >= percent) {
      running = 0;
      continue;
    }
    ++running;
    all[i - 1].at_us = all[i].at_us + 50;
    std::swap(all[i - 1], all[i]);
    ++i;
  }
}

/// The datagrams as a network delivers them that collects them for `bunch_us`.
Datagrams bunched(Datagrams all, std::int64_t bunch_us) {
  std::int64_t last = 0;
  for (Datagram& one : all) {
    last = one.at_us = std::max((one.at_us / bunch_us + 1) * bunch_us, last + 20);
  }
  return all;
}

}  // namespace

TEST_CASE("noitom datagrams: if nothing is lost every frame is given, with its own arrival") {
  for (const auto form : {NoitomForm::old_header, NoitomForm::new_header}) {
    for (const std::size_t pieces : {1, 2, 3, 4, 7}) {
      CAPTURE(pieces);
      const Received received = receive(sent(form, 50, pieces));
      REQUIRE(received.arrivals.size() == 50);
      CHECK(mixed(received) == 0);
      CHECK(received.counts.bytes_skipped == 0);
      if (pieces == 1) continue;
      for (std::int64_t k = 0; k < 50; ++k) {
        const std::int64_t ended = 8000 * k + 100 * static_cast<std::int64_t>(pieces - 1);
        CHECK(received.arrivals[static_cast<std::size_t>(k)].arrival ==
              HostTime{std::chrono::microseconds(ended)});
      }
    }
  }
}

TEST_CASE("noitom datagrams: numbered frames are given whenever their pieces arrive") {
  const Datagrams apart = sent(NoitomForm::new_header, 100, 2, 7600);
  CHECK(receive(apart).arrivals.size() == 99);  // the last one waits for a number
  for (const std::int64_t bunch : {50'000, 100'000}) {
    CHECK(receive(bunched(apart, bunch)).arrivals.size() >= 99);
  }
  CHECK(receive(sent(NoitomForm::old_header, 100, 2, 4000)).arrivals.size() == 100);
  const Received late = receive(sent(NoitomForm::old_header, 100, 2, 4100));
  CHECK(late.arrivals.empty());
  CHECK(late.counts[NoitomRefusal::incomplete] == 99);
}

TEST_CASE("noitom datagrams: losses mix no numbered frames, whenever the pieces arrive") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    for (const std::int64_t gap : {100, 2000, 6000}) {
      for (const int in_a_row : {1, 2, 3}) {
        const auto left = without(sent(NoitomForm::new_header, 600, 2, gap), 5, in_a_row, random);
        const Received received = receive(left);
        CHECK(mixed(received) == 0);
        CHECK(received.counts[NoitomRefusal::incomplete] > 0);
        CHECK(received.arrivals.size() >= 250);
        // Only the last frame, which no number follows, is accepted by its time.
        CHECK(mixed(receive(bunched(left, 50'000))) <= 1);
      }
    }
  }
}

TEST_CASE("noitom datagrams: losses mix no frames without numbers at the pace of a suit") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Received received = receive(without(sent(NoitomForm::old_header, 600, 2), 5, 1, random));
    CHECK(mixed(received) == 0);
    CHECK(received.arrivals.size() >= 250);
  }
}

TEST_CASE("noitom datagrams: datagrams out of order mix no frames") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    for (const auto form : {NoitomForm::new_header, NoitomForm::old_header}) {
      Datagrams all = sent(form, 600, 2);
      swap_some(all, 2, random);
      const Received received = receive(all);
      CHECK(mixed(received) == 0);
      CHECK(received.arrivals.size() >= 450);
    }
    Datagrams left = without(sent(NoitomForm::new_header, 600, 2), 5, 1, random);
    swap_some(left, 2, random);
    CHECK(mixed(receive(left)) <= 6);  // both faults at once mix frames, as the page says
  }
}

TEST_CASE("noitom datagrams: a truncated datagram costs a frame, and the next one if it is cut") {
  for (const auto seed : fresh_seeds(10)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    for (const std::size_t pieces : {1, 2}) {
      Datagrams all = sent(NoitomForm::new_header, 300, pieces);
      for (Datagram& one : all) {
        if (random() % 20 == 0) one.bytes.resize(one.bytes.size() - 1 - random() % 100);
      }
      const Received received = receive(all);
      CHECK(mixed(received) == 0);
      CHECK(received.arrivals.size() >= (pieces == 1 ? 200 : 150));
    }
  }
}

TEST_CASE("noitom datagrams: three missing bytes cost one frame, and the next one is whole") {
  Datagrams all = sent(NoitomForm::new_header, 6, 1);
  for (const std::size_t cut : {1, 2, 4}) all[cut].bytes.resize(1477);
  const Received received = receive(all);
  CHECK(received.indices() == std::vector<std::uint32_t>{0, 3, 5});
  CHECK(mixed(received) == 0);
  CHECK(received.counts[NoitomRefusal::incomplete] == 3);
}

TEST_CASE("noitom datagrams: halves of two frames are dropped, by their numbers or their time") {
  const Datagrams lost{head(0), tail(0), head(1), tail(1), head(2), tail(3),
                       head(4), tail(4), head(5), tail(5), head(6)};
  const Received by_numbers = receive(lost);
  CHECK(by_numbers.indices() == std::vector<std::uint32_t>{0, 1, 5});
  CHECK(by_numbers.counts[NoitomRefusal::incomplete] == 2);  // frame 2, and frame 4 after it
  Datagrams old;
  for (const auto& [frame, piece] : {std::pair{0U, 0U}, {0U, 1U}, {1U, 0U}, {2U, 1U}}) {
    old.push_back(half(frame, piece, NoitomForm::old_header));
  }
  CHECK(receive(old).arrivals.size() == 1);
}

TEST_CASE("noitom datagrams: a piece that arrives after the next header ends no frame") {
  const Datagrams all{head(0), tail(0), head(1), head(2), tail(1), tail(2),
                      head(3), tail(3), head(4), tail(4), head(5), tail(5)};
  const Received received = receive(all);
  CHECK(mixed(received) == 0);
  CHECK(received.indices() == std::vector<std::uint32_t>{0, 4, 5});
  const Datagrams twice{head(0), tail(0), head(1), head(2), tail(1),
                        head(3), tail(2), tail(3), head(4)};
  CHECK(receive(twice).indices() == std::vector<std::uint32_t>{0});
}

TEST_CASE("noitom datagrams: an incomplete frame does not take bytes of a whole one") {
  const Received received =
      receive({head(0), tail(0), head(1), {sent_bytes(2), 16'000}, {sent_bytes(3), 24'000}});
  CHECK(received.indices() == std::vector<std::uint32_t>{0, 2, 3});
  CHECK(received.counts[NoitomRefusal::incomplete] == 1);
}

TEST_CASE("noitom datagrams: a header that is cut in two is none") {
  const Bytes one = sent_bytes(0);
  for (const std::ptrdiff_t cut : {1, 5, 30, 63}) {
    const Datagrams all{{Bytes(one.begin(), one.begin() + cut), 0},
                        {Bytes(one.begin() + cut, one.end()), 100},
                        {sent_bytes(1), 8000}};
    CHECK(receive(all).indices() == std::vector<std::uint32_t>{1});
  }
}

TEST_CASE("noitom datagrams: equal datagrams are two frames, or pieces of one") {
  const Datagram whole{sent_bytes(0), 0};
  CHECK(receive({whole, whole}).arrivals.back().order == Order::duplicate);
  NoitomFrame still = sent_frame(NoitomForm::new_header, 0);
  std::fill(still.values.begin(), still.values.end(), 0.0F);
  const Bytes bytes = bytes_of(still);
  Datagrams pieces{{Bytes(bytes.begin(), bytes.begin() + 480), 0}};
  pieces.insert(pieces.end(), 2, {Bytes(500, 0), 100});
  CHECK(receive(pieces).arrivals.size() == 1);
}

TEST_CASE("noitom datagrams: several frames in one datagram are all there, the last one cut") {
  Bytes joined = sent_bytes(0);
  joined += sent_bytes(1);
  joined += head(2).bytes;
  const Received received =
      receive({{joined, 0}, {tail(2).bytes, 100}, {head(3).bytes, 8000}, {tail(3).bytes, 8100}});
  CHECK(received.indices() == std::vector<std::uint32_t>{0, 1, 2, 3});
  CHECK(received.counts.bytes_skipped == 0);
}

TEST_CASE("noitom datagrams: several avatars take turns under one number") {
  Datagrams turns;
  for (std::uint32_t k = 0; k < 20; ++k) {
    for (const std::uint32_t avatar : {0U, 1U}) {
      NoitomFrame frame = sent_frame(NoitomForm::new_header, k);
      frame.avatar = avatar;
      const Bytes bytes = bytes_of(frame);
      turns.push_back({Bytes(bytes.begin(), bytes.begin() + 740), 8000 * k + 500 * avatar});
      turns.push_back({Bytes(bytes.begin() + 740, bytes.end()), 8000 * k + 500 * avatar + 100});
    }
  }
  CHECK(receive(turns).arrivals.size() == 40);
}

TEST_CASE("noitom datagrams: of a sender that leaves numbers out only whole datagrams are read") {
  Datagrams cut, whole;
  for (std::uint32_t k = 0; k < 20; k += 2) {
    cut.insert(cut.end(), {head(k), tail(k)});
    whole.push_back({sent_bytes(k), 8000 * k});
  }
  CHECK(receive(cut).indices() ==
        std::vector<std::uint32_t>{18});  // nothing follows the last frame
  CHECK(receive(cut).counts[NoitomRefusal::incomplete] == 9);
  CHECK(receive(whole).arrivals.size() == 10);
}

TEST_CASE(
    "noitom datagrams: a sender of 80 of 120 frames loses only those before a missing number") {
  Datagrams cut;
  for (std::uint32_t k = 0; k < 30; ++k) {
    if (k % 3 != 2) cut.insert(cut.end(), {head(k), tail(k)});
  }
  const Received received = receive(cut);
  CHECK(received.indices() == std::vector<std::uint32_t>{0, 3, 6, 9, 12, 15, 18, 21, 24, 27, 28});
  CHECK(received.counts[NoitomRefusal::incomplete] == 9);
}

TEST_CASE("noitom datagrams: the number of a dropped frame is not lost") {
  const Datagrams without_an_end{head(0), tail(0), head(1), head(2), tail(2), head(3),
                                 tail(3), head(4), tail(4), head(5), tail(5)};
  const Received dropped = receive(without_an_end);
  CHECK(dropped.indices() == std::vector<std::uint32_t>{0, 3, 4, 5});
  CHECK(dropped.lost == 0);
  CHECK(dropped.counts[NoitomRefusal::incomplete] == 2);
  Datagrams without_a_header = sent(NoitomForm::new_header, 8, 2);
  without_a_header.erase(without_a_header.begin() + 4);
  CHECK(receive(without_a_header).lost == 1);
}

TEST_CASE("noitom datagrams: the last frame waits for a next one, and is known before") {
  NoitomReceiver receiver(NoitomParts::heads);
  std::vector<NoitomArrival> out;
  const auto feed = [&](const Datagram& one) {
    receiver.feed_datagram(one.bytes, HostTime{std::chrono::microseconds(one.at_us)}, out);
  };
  feed(head(0));
  CHECK_FALSE(receiver.has_last());
  feed(tail(0));
  CHECK(out.empty());
  CHECK(receiver.has_last());
  feed(head(1));
  CHECK(out.size() == 1);
  CHECK_FALSE(receiver.has_last());
}

TEST_CASE("noitom datagrams: a note says that frames arrive in pieces") {
  CHECK(receive(sent(NoitomForm::new_header, 3, 1)).findings.empty());
  const Received received = receive(sent(NoitomForm::new_header, 3, 3));
  REQUIRE(received.findings.size() == 1);
  CHECK(received.findings[0].severity == Severity::note);
  CHECK(to_string(received.findings[0].what) ==
        "axis: expected each frame in one datagram, found frames in several datagrams");
  CHECK(received.findings[0].repair == "use TCP");
}

TEST_CASE("noitom datagrams: text and other streams are read as over a connection") {
  const Bytes text = bytes_of(noitom_frame(NoitomForm::text, true, false));
  const auto middle = text.begin() + static_cast<std::ptrdiff_t>(text.size() / 2);
  const Datagrams all{{Bytes(text.begin(), middle), 0}, {Bytes(middle, text.end()), 100}};
  CHECK(receive(all).arrivals.size() == 1);
  Bytes other = sent_bytes(0);
  other.resize(64 + 4 * 366);
  other[6] = 366 & 0xff;
  other[7] = 366 >> 8;
  CHECK(receive({{other, 0}, {other, 8000}, {sent_bytes(1), 16'000}})
            .counts[NoitomRefusal::wrong_count] == 2);
}

TEST_CASE("noitom datagrams: few bytes of damaged datagrams are kept") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    Datagrams all = sent(NoitomForm::new_header, 200, 3);
    for (Datagram& one : all) {
      if (random() % 4 == 0) one.bytes[random() % one.bytes.size()] = 0xff;
      if (random() % 10 == 0) one.bytes.insert(one.bytes.end(), random() % 5000, 'C');
      if (random() % 10 == 0) one.bytes.resize(random() % one.bytes.size());
    }
    std::shuffle(all.begin(), all.end(), random);
    receive(all);  // checks the number of bytes that wait
  }
}
