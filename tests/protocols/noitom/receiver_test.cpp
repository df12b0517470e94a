// SPDX-License-Identifier: Apache-2.0
// Datagrams of the BVH broadcast that are lost, overtaken, doubled or cut short.
#include "kinalign/protocols/noitom/receiver.h"

#include "tests/protocols/noitom/noitom_cases.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>

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

/// A frame each 8 ms, its pieces 0.1 ms apart.
Datagrams sent(NoitomForm form, std::uint32_t frames, std::size_t pieces) {
  Datagrams all;
  for (std::uint32_t k = 0; k < frames; ++k) {
    const Bytes bytes = sent_bytes(k, form);
    for (std::size_t p = 0; p < pieces; ++p) {
      const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() * p / pieces);
      const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() * (p + 1) / pieces);
      all.push_back({Bytes(begin, end), 8000 * k + 100 * static_cast<std::int64_t>(p)});
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

struct Heard {
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

enum class Arrivals { known, unknown };

Heard hear(const Datagrams& datagrams, Arrivals arrivals = Arrivals::known) {
  NoitomReceiver receiver;
  Heard heard;
  for (const Datagram& one : datagrams) {
    std::optional<HostTime> arrival;
    if (arrivals == Arrivals::known) arrival = HostTime{std::chrono::microseconds(one.at_us)};
    receiver.feed_datagram(one.bytes, arrival, heard.arrivals);
    CHECK(receiver.waiting() <= 24'576);
  }
  receiver.finish(heard.arrivals);
  heard.counts = receiver.counts();
  for (const auto& [index, avatar] : receiver.avatars())
    heard.lost += avatar.by_index.counts().lost;
  heard.findings = receiver.findings("axis");
  return heard;
}

/// The number of received frames that nobody sent.
std::size_t never_sent(const Heard& heard) {
  std::size_t strange = 0;
  for (const NoitomArrival& one : heard.arrivals) {
    const auto index = static_cast<std::uint32_t>(one.frame.values.at(0) / 1000.0F);
    if (!(one.frame == sent_frame(one.frame.form, index))) ++strange;
  }
  return strange;
}

/// The datagrams without a random share of `in_a_hundred` percent. Those of the first frame stay,
/// because at a stream's start nothing is known of earlier ones.
Datagrams without(const Datagrams& all, unsigned in_a_hundred, std::mt19937_64& random) {
  Datagrams left;
  for (const Datagram& one : all) {
    if (left.size() < 2 || random() % 100 >= in_a_hundred) left.push_back(one);
  }
  return left;
}

/// Lets `in_a_hundred` percent of the datagrams be overtaken by the next one and arrive just after
/// it. At most two in a row: the page says that more are not noticed.
void overtake(Datagrams& all, unsigned in_a_hundred, std::mt19937_64& random) {
  int running = 0;
  for (std::size_t i = 3; i < all.size(); ++i) {
    if (running >= 2 || random() % 100 >= in_a_hundred) {
      running = 0;
      continue;
    }
    ++running;
    all[i - 1].at_us = all[i].at_us + 50;
    std::swap(all[i - 1], all[i]);
    ++i;
  }
}

std::size_t count_whole(const Datagrams& heard) {
  std::map<std::int64_t, int> pieces;
  for (const Datagram& one : heard) ++pieces[one.at_us / 8000];
  return static_cast<std::size_t>(
      std::count_if(pieces.begin(), pieces.end(), [](const auto& p) { return p.second == 2; }));
}

}  // namespace

TEST_CASE("noitom datagrams: where nothing is lost every frame is given, with its own arrival") {
  for (const auto form : {NoitomForm::old_header, NoitomForm::new_header}) {
    for (const std::size_t pieces : {1, 2, 3, 4, 7}) {
      CAPTURE(pieces);
      const Heard heard = hear(sent(form, 50, pieces));
      REQUIRE(heard.arrivals.size() == 50);
      CHECK(never_sent(heard) == 0);
      CHECK(heard.counts.bytes_skipped == 0);
      if (pieces == 1) continue;
      for (std::int64_t k = 0; k < 50; ++k) {
        const std::int64_t ended = 8000 * k + 100 * static_cast<std::int64_t>(pieces - 1);
        CHECK(heard.arrivals[static_cast<std::size_t>(k)].arrival ==
              HostTime{std::chrono::microseconds(ended)});
      }
    }
  }
}

TEST_CASE(
    "noitom datagrams: no frame is given that was not sent, where some are lost or overtaken") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto check = [&](NoitomForm form, unsigned lost, unsigned overtaken, std::size_t mixed) {
      Datagrams heard = without(sent(form, 600, 2), lost, random);
      // The loss of this piece is left out: the first loss can be one of three things at once that
      // look like a number that was left out.
      std::erase_if(heard, [](const Datagram& one) { return one.at_us == tail(2).at_us; });
      const std::size_t whole = count_whole(heard);
      overtake(heard, overtaken, random);
      const Heard all = hear(heard);
      CHECK(never_sent(all) <= mixed);
      CHECK(all.arrivals.size() <= whole + mixed);
      CHECK(all.arrivals.size() >= 250);
      CHECK(all.counts[NoitomRefusal::torn] > 0);
    };
    for (const auto form : {NoitomForm::new_header, NoitomForm::old_header}) {
      check(form, 5, 0, 0);
      check(form, 0, 2, 0);
    }
    // Losses and overtaking together mix a frame in one of 200 runs. Frames without numbers are
    // mixed more often, as the page says.
    check(NoitomForm::new_header, 5, 2, 1);
  }
}

TEST_CASE("noitom datagrams: losses alone mix no numbered frames, whenever the pieces came") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Heard all =
        hear(without(sent(NoitomForm::new_header, 600, 2), 5, random), Arrivals::unknown);
    CHECK(never_sent(all) == 0);
    CHECK(all.arrivals.size() >= 250);
  }
}

TEST_CASE("noitom datagrams: datagrams cut short cost their own frames alone") {
  for (const auto seed : fresh_seeds(10)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    for (const std::size_t pieces : {1, 2}) {
      Datagrams all = sent(NoitomForm::new_header, 300, pieces);
      for (Datagram& one : all) {
        if (random() % 20 == 0) one.bytes.resize(one.bytes.size() - 1 - random() % 100);
      }
      const Heard heard = hear(all);
      CHECK(never_sent(heard) == 0);
      CHECK(heard.arrivals.size() >= (pieces == 1 ? 200 : 150));
    }
  }
}

TEST_CASE("noitom datagrams: three bytes less are a frame less, and the next one is whole") {
  Datagrams all = sent(NoitomForm::new_header, 6, 1);
  for (const std::size_t cut : {1, 2, 4}) all[cut].bytes.resize(1477);
  const Heard heard = hear(all);
  CHECK(heard.indices() == std::vector<std::uint32_t>{0, 3, 5});
  CHECK(never_sent(heard) == 0);
  CHECK(heard.counts[NoitomRefusal::torn] == 3);
}

TEST_CASE("noitom datagrams: halves of two frames are none, by their arrivals or their numbers") {
  const Datagrams lost{head(0), tail(0), head(1), tail(1), head(2), tail(3),
                       head(4), tail(4), head(5), tail(5), head(6)};
  CHECK(hear(lost).indices() == std::vector<std::uint32_t>{0, 1, 5});
  // A receiver that does not know the arrivals has the frames' numbers: 3 is missing between 2 and
  // 4.
  const Heard by_numbers = hear(lost, Arrivals::unknown);
  CHECK(by_numbers.indices() == std::vector<std::uint32_t>{0, 1, 5});
  CHECK(by_numbers.counts[NoitomRefusal::torn] == 2);  // frame 2, and frame 4 after it
  Datagrams old;
  for (const auto& [frame, piece] : {std::pair{0U, 0U}, {0U, 1U}, {1U, 0U}, {2U, 1U}}) {
    old.push_back(half(frame, piece, NoitomForm::old_header));
  }
  CHECK(hear(old).arrivals.size() == 1);
}

TEST_CASE("noitom datagrams: a piece that another frame's header overtook ends no frame") {
  Datagrams all{head(0), tail(0), head(1), head(2), tail(1), tail(2),
                head(3), tail(3), head(4), tail(4), head(5), tail(5)};
  all[4].at_us = all[3].at_us + 50;
  const Heard heard = hear(all);
  CHECK(never_sent(heard) == 0);
  CHECK(heard.indices() == std::vector<std::uint32_t>{0, 4, 5});
  // The same twice in a row.
  Datagrams twice{head(0), tail(0), head(1), head(2), tail(1), head(3), tail(2), tail(3), head(4)};
  twice[4].at_us = twice[3].at_us + 50;
  twice[6].at_us = twice[5].at_us + 50;
  CHECK(hear(twice).indices() == std::vector<std::uint32_t>{0});
}

TEST_CASE("noitom datagrams: a beginning whose rest does not come swallows nothing") {
  const Datagrams all{head(0), tail(0), head(1), {sent_bytes(2), 16'000}, head(3), tail(3)};
  const Heard heard = hear(all);
  CHECK(heard.indices() == std::vector<std::uint32_t>{0, 2, 3});
  CHECK(heard.counts[NoitomRefusal::torn] == 1);
}

TEST_CASE("noitom datagrams: a header that is cut in two is none") {
  const Bytes one = sent_bytes(0);
  for (const std::ptrdiff_t cut : {1, 5, 30, 63}) {
    const Datagrams all{{Bytes(one.begin(), one.begin() + cut), 0},
                        {Bytes(one.begin() + cut, one.end()), 100},
                        {sent_bytes(1), 8000}};
    CHECK(hear(all).indices() == std::vector<std::uint32_t>{1});
  }
}

TEST_CASE("noitom datagrams: another cut than the sender's is doubted, until it is the sender's") {
  Datagrams all = sent(NoitomForm::new_header, 10, 2);
  for (std::size_t k = 4; k < 10; ++k) {
    const Bytes bytes = sent_bytes(static_cast<std::uint32_t>(k));
    all[2 * k].bytes.assign(bytes.begin(), bytes.begin() + 1000);
    all[2 * k + 1].bytes.assign(bytes.begin() + 1000, bytes.end());
  }
  CHECK(hear(all).indices() == std::vector<std::uint32_t>{0, 1, 2, 3, 6, 7, 8, 9});
}

TEST_CASE("noitom datagrams: what comes twice is there once, a whole datagram as ever") {
  Datagrams all;
  for (const Datagram& one : sent(NoitomForm::new_header, 5, 2)) all.insert(all.end(), 2, one);
  const Heard pieced = hear(all);
  CHECK(pieced.indices() == std::vector<std::uint32_t>{0, 1, 2, 3, 4});
  CHECK(pieced.counts.bytes_skipped == 0);
  const Datagram whole{sent_bytes(0), 0};
  CHECK(hear({whole, whole}).arrivals.back().order == Order::duplicate);
  // Equal pieces of one frame do not count as doubled datagrams.
  NoitomFrame still = sent_frame(NoitomForm::new_header, 0);
  std::fill(still.values.begin(), still.values.end(), 0.0F);
  const Bytes bytes = bytes_of(still);
  Datagrams pieces{{Bytes(bytes.begin(), bytes.begin() + 480), 0}};
  pieces.insert(pieces.end(), 2, {Bytes(500, 0), 100});
  CHECK(hear(pieces).arrivals.size() == 1);
}

TEST_CASE("noitom datagrams: frames joined in one are all there, whole or with a piece") {
  Bytes joined = sent_bytes(0);
  joined += sent_bytes(1);
  joined += head(2).bytes;
  Bytes rest = tail(2).bytes;
  rest += head(3).bytes;
  const Heard heard = hear({{joined, 0}, {rest, 100}, {tail(3).bytes, 200}});
  CHECK(heard.indices() == std::vector<std::uint32_t>{0, 1, 2, 3});
  CHECK(heard.counts.bytes_skipped == 0);
}

TEST_CASE("noitom datagrams: avatars in turn and numbers left out are no losses") {
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
  CHECK(hear(turns).arrivals.size() == 40);
}

namespace {

/// Frames of these numbers, one each `period_us`, each in two pieces, the second of which comes
/// `gap_us()` later.
Datagrams paced(const std::vector<std::uint32_t>& numbers, std::int64_t period_us,
                const std::function<std::int64_t()>& gap_us,
                NoitomForm form = NoitomForm::new_header) {
  Datagrams all;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    for (const std::size_t piece : {0U, 1U}) {
      all.push_back(half(0, piece, form));
      const Bytes bytes = sent_bytes(numbers[k], form);
      const auto middle = bytes.begin() + 740;
      all.back().bytes = piece == 0 ? Bytes(bytes.begin(), middle) : Bytes(middle, bytes.end());
      all.back().at_us = period_us * static_cast<std::int64_t>(k) + (piece == 0 ? 0 : gap_us());
    }
  }
  return all;
}

/// Numbers from 0 on that grow by the `steps` in turn.
std::vector<std::uint32_t> numbers_by(const std::vector<std::uint32_t>& steps, std::size_t count) {
  std::vector<std::uint32_t> numbers{0};
  while (numbers.size() < count) {
    numbers.push_back(numbers.back() + steps[(numbers.size() - 1) % steps.size()]);
  }
  return numbers;
}

std::vector<std::vector<std::uint32_t>> steps_of_senders() {
  // Every frame; every second one; 80 and 100 of 120.
  return {{1}, {2}, {1, 2}, {1, 1, 1, 1, 2}};
}

}  // namespace

TEST_CASE("noitom datagrams: where nothing is lost all are given, whatever numbers are left out") {
  for (const auto& steps : steps_of_senders()) {
    for (const std::int64_t period : {8000, 10'000, 16'667}) {
      for (const std::int64_t gap : {0, 100, 3000}) {
        CAPTURE(steps.size());
        CAPTURE(gap);
        const Heard heard = hear(paced(numbers_by(steps, 300), period, [&] { return gap; }));
        CHECK(heard.arrivals.size() == 300);
        CHECK(heard.counts[NoitomRefusal::torn] == 0);
      }
    }
  }
  // One or two are left out now and then, at random.
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::vector<std::uint32_t> numbers{0};
    while (numbers.size() < 300) {
      const auto step = static_cast<std::uint32_t>(random() % 8 == 0 ? 2 + random() % 2 : 1);
      numbers.push_back(numbers.back() + step);
    }
    CHECK(hear(paced(numbers, 10'000, [] { return 200; })).arrivals.size() == 300);
  }
}

TEST_CASE("noitom datagrams: where nothing is lost pieces may come a whole period apart") {
  for (const std::int64_t period : {8000, 10'000, 16'667}) {
    for (const std::int64_t percent : {45, 60, 80, 95}) {
      for (const auto& steps : steps_of_senders()) {
        CAPTURE(period);
        CAPTURE(percent);
        const auto gap = [&] { return period * percent / 100; };
        const Heard heard = hear(paced(numbers_by(steps, 400), period, gap));
        CHECK(heard.arrivals.size() >= (steps == std::vector<std::uint32_t>{1} ? 399 : 380));
        CHECK(heard.lost <= numbers_by(steps, 400).back() + 1 - 400);
      }
    }
  }
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::exponential_distribution<double> late(1.0 / 2000);
    const auto gap = [&] { return std::min<std::int64_t>(9900, std::llround(late(random))); };
    CHECK(hear(paced(numbers_by({1}, 400), 10'000, gap)).arrivals.size() >= 399);
  }
}

namespace {

/// The datagrams as a network delivers them that collects them for `bunch_us`.
Datagrams bunched(Datagrams all, std::int64_t bunch_us) {
  std::int64_t last = 0;
  for (Datagram& one : all) {
    last = one.at_us = std::max((one.at_us / bunch_us + 1) * bunch_us, last + 20);
  }
  return all;
}

}  // namespace

TEST_CASE("noitom datagrams: where nothing is lost they may come in bunches") {
  for (const std::int64_t bunch : {50'000, 100'000}) {
    for (const auto& steps : steps_of_senders()) {
      CAPTURE(bunch);
      CAPTURE(steps.size());
      const auto gap = [] { return 100; };
      const Heard heard = hear(bunched(paced(numbers_by(steps, 400), 8000, gap), bunch));
      CHECK(heard.arrivals.size() >= 380);
      CHECK(never_sent(heard) == 0);
    }
  }
}

TEST_CASE("noitom datagrams: what interference takes from each sixth frame is no number left out") {
  for (const auto seed : fresh_seeds(10)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    for (const std::int64_t every : {6, 7, 8}) {
      for (const auto& [gap, burst] : {std::pair{100, 8050}, {2000, 8050}, {4000, 5000}}) {
        CAPTURE(every);
        CAPTURE(gap);
        const std::int64_t period = 8000 * every + static_cast<std::int64_t>(random() % 81) - 40;
        const auto phase = static_cast<std::int64_t>(random() % 8000);
        Datagrams left = paced(numbers_by({1}, 2000), 8000, [gap = gap] { return gap; });
        std::erase_if(left, [&, burst = burst](const Datagram& one) {
          return one.at_us > 1'000'000 && (one.at_us + phase) % period < burst;
        });
        CHECK(never_sent(hear(left)) == 0);
      }
    }
  }
}

TEST_CASE("noitom datagrams: bunches that lose two pieces running mix next to no frames") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    for (const std::int64_t bunch : {50'000, 100'000}) {
      int lost = 0;
      Datagrams left;
      for (const Datagram& one : sent(NoitomForm::new_header, 480, 2)) {
        if (left.size() > 120 && random() % 20 == 0) lost = 2;
        if (lost > 0 && lost-- > 0) continue;
        left.push_back(one);
      }
      const Heard heard = hear(bunched(left, bunch));
      // Frames may be mixed where the sender's usual step is learnt as two; 3 of 4,000 seeds.
      CHECK(never_sent(heard) <= 4);
      CHECK(heard.arrivals.size() > 200);
    }
  }
}

TEST_CASE("noitom datagrams: without numbers a longer gap is known after some frames") {
  for (const auto form : {NoitomForm::old_header}) {
    const auto gap = [] { return 6000; };
    CHECK(hear(paced(numbers_by({1}, 100), 10'000, gap, form)).arrivals.size() >= 90);
  }
}

TEST_CASE("noitom datagrams: losses mix no frames at the pace of a suit, whatever the gap") {
  for (const auto seed : fresh_seeds(5)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    for (const auto& steps : steps_of_senders()) {
      for (const std::int64_t period : {8000, 10'000, 16'667}) {
        for (const std::int64_t percent : {1, 30, 60}) {
          CAPTURE(period);
          CAPTURE(percent);
          const auto gap = [&] { return period * percent / 100; };
          const Datagrams all = paced(numbers_by(steps, 500), period, gap);
          const Heard heard = hear(without(all, 5, random));
          CHECK(never_sent(heard) == 0);
          CHECK(heard.arrivals.size() >= 150);
        }
      }
    }
  }
}

TEST_CASE("noitom datagrams: an end that came before its own header ends no frame before") {
  Datagrams all{head(0), tail(0), head(1), tail(2), head(2), head(3), tail(3), head(4), tail(4)};
  all[4].at_us = all[3].at_us + 50;
  const Heard heard = hear(all);
  CHECK(never_sent(heard) == 0);
  CHECK(heard.indices() == std::vector<std::uint32_t>{0});
  CHECK(heard.counts.frames == 1);
}

TEST_CASE("noitom datagrams: a frame whose header came is not lost by its number") {
  const Datagrams without_an_end{head(0), tail(0), head(1), head(2), tail(2), head(3),
                                 tail(3), head(4), tail(4), head(5), tail(5)};
  const Heard torn = hear(without_an_end);
  CHECK(torn.indices() == std::vector<std::uint32_t>{0, 4, 5});
  CHECK(torn.lost == 0);
  CHECK(torn.counts[NoitomRefusal::torn] == 3);
  Datagrams without_a_header = sent(NoitomForm::new_header, 8, 2);
  without_a_header.erase(without_a_header.begin() + 4);
  CHECK(hear(without_a_header).lost == 1);
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

TEST_CASE("noitom datagrams: of frames in pieces there is a note") {
  CHECK(hear(sent(NoitomForm::new_header, 3, 1)).findings.empty());
  const Heard heard = hear(sent(NoitomForm::new_header, 3, 3));
  REQUIRE(heard.findings.size() == 1);
  CHECK(heard.findings[0].severity == Severity::note);
  CHECK(to_string(heard.findings[0].what) ==
        "axis: expected each frame in one datagram, found frames in 3 datagrams each");
  CHECK(heard.findings[0].repair == "prefer TCP");
}

TEST_CASE("noitom datagrams: text and other streams are read as over a connection") {
  const Bytes text = bytes_of(noitom_frame(NoitomForm::text, true, false));
  const auto middle = text.begin() + static_cast<std::ptrdiff_t>(text.size() / 2);
  const Datagrams all{{Bytes(text.begin(), middle), 0}, {Bytes(middle, text.end()), 100}};
  CHECK(hear(all).arrivals.size() == 1);
  Bytes other = sent_bytes(0);
  other.resize(64 + 4 * 366);
  other[6] = 366 & 0xff;
  other[7] = 366 >> 8;
  CHECK(hear({{other, 0}, {other, 8000}, {sent_bytes(1), 16'000}})
            .counts[NoitomRefusal::wrong_count] == 2);
}

TEST_CASE("noitom datagrams: of rubbish little is kept") {
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
    hear(all);  // it looks at the datagrams that wait
  }
}
