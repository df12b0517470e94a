// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/noitom/stream.h"

#include "tests/page_bytes.h"
#include "tests/protocols/noitom/noitom_cases.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

constexpr std::array forms{NoitomForm::old_header, NoitomForm::new_header, NoitomForm::text};

std::vector<NoitomFrame> every_variant() {
  std::vector<NoitomFrame> frames;
  for (const auto form : forms) {
    for (const bool displacement : {false, true}) {
      for (const bool reference : {false, true}) {
        frames.push_back(noitom_frame(form, displacement, reference));
      }
    }
  }
  return frames;
}

Bytes repeated(std::uint8_t byte, std::size_t times) { return Bytes(times, byte); }

Bytes sent_again(const std::vector<NoitomFrame>& frames) {
  Bytes bytes;
  for (const auto& frame : frames) bytes += bytes_of(frame);
  return bytes;
}

/// A header of 64 bytes with the tokens of Noitom's other streams.
Bytes other_header(std::uint8_t first, std::uint8_t last) {
  Bytes bytes(64, 0);
  bytes[0] = bytes[62] = 0xff;
  bytes[1] = first;
  bytes[63] = last;
  return bytes;
}

}  // namespace

TEST_CASE("noitom: the page's frames are what is read and sent") {
  NoitomFrame frame = noitom_frame(NoitomForm::new_header, false, false);
  std::fill(frame.values.begin(), frame.values.end(), 0.0F);
  const std::array<float, 6> root{0.5F, 93.25F, -1.0F, 0.0F, 90.0F, -45.0F};
  std::copy(root.begin(), root.end(), frame.values.begin());
  Bytes page = bytes_of_page("noitom_stream.md", "new header");
  page.resize(64 + 4 * 180);
  CHECK(page == bytes_of(frame));
  CHECK(read_noitom(page).frames == std::vector{frame});

  const NoitomFrame old = noitom_frame(NoitomForm::old_header, true, true);
  page = bytes_of_page("noitom_stream.md", "old header");
  const Bytes sent = bytes_of(old);
  CHECK(page == Bytes(sent.begin(), sent.begin() + 64));
}

TEST_CASE("noitom: the page's text is a frame") {
  std::string text = "1 Char01 0.5 93.25 -1 0 90 -45";
  for (int k = 6; k < 180; ++k) text += " 0";
  const auto read = read_noitom(bytes_of(text + " ||"));
  REQUIRE(read.frames.size() == 1);
  CHECK(read.frames[0].form == NoitomForm::text);
  CHECK(read.frames[0].avatar == 1);
  CHECK(read.frames[0].name == "Char01");
  CHECK(read.frames[0].values[5] == -45.0F);
  CHECK(!read.frames[0].displacement);
}

TEST_CASE("noitom: every variant is read as it was sent") {
  for (const auto& frame : every_variant()) {
    CAPTURE(static_cast<int>(frame.form));
    const auto read = read_noitom(bytes_of(frame));
    CHECK(read.frames == std::vector{frame});
    CHECK(read.counts.bytes_skipped == 0);
    CHECK(read.findings.empty());
  }
  CHECK(bytes_of(noitom_frame(NoitomForm::new_header, true, false)).size() == 1480);
}

namespace {

/// A dozen frames, some of them damaged, with random bytes between them.
Bytes damaged_frames(std::mt19937_64& random) {
  Bytes bytes;
  const auto variants = every_variant();
  for (int k = 0; k < 12; ++k) {
    Bytes part = bytes_of(variants[random() % variants.size()]);
    if (random() % 3 == 0) part[random() % part.size()] = static_cast<std::uint8_t>(random());
    if (random() % 4 == 0) part[6] = static_cast<std::uint8_t>(random());  // a count
    if (random() % 4 == 0) part.resize(random() % part.size());
    bytes += part;
    for (std::uint64_t n = random() % 40; n > 0; --n) {
      bytes.push_back(random() % 4 == 0 ? 0xff : static_cast<std::uint8_t>(random()));
    }
  }
  return bytes;
}

}  // namespace

TEST_CASE("noitom: where bytes are cut changes nothing") {
  for (const auto seed : fresh_seeds(60)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Bytes bytes = damaged_frames(random);
    const auto whole = read_noitom(bytes);
    for (const std::size_t most : {1, 7, 100, 2000}) {
      const auto cut = read_noitom(bytes, most, seed);
      // Compared as bytes, because NaN is one of the values.
      CHECK(sent_again(cut.frames) == sent_again(whole.frames));
      CHECK(cut.counts == whole.counts);
    }
  }
}

TEST_CASE("noitom: who only counts gets the same frames without their values") {
  NoitomDecoder decoder(NoitomParts::heads);
  std::vector<NoitomArrival> heads;
  const Bytes bytes = sent_again(every_variant());
  decoder.feed(bytes, heads);
  const auto read = read_noitom(bytes);
  CHECK(decoder.counts() == read.counts);
  REQUIRE(heads.size() == read.frames.size());
  for (std::size_t i = 0; i < heads.size(); ++i) {
    NoitomFrame expected = read.frames[i];
    if (expected.form != NoitomForm::text) expected.values.clear();
    CHECK(heads[i].frame == expected);
  }
}

TEST_CASE("noitom: text frames need no line end and may have one") {
  Bytes bytes = bytes_of(noitom_frame(NoitomForm::text, false, false));
  bytes += bytes_of("\r\n");
  bytes += bytes_of(noitom_frame(NoitomForm::text, true, false));
  bytes += bytes_of(noitom_frame(NoitomForm::text, true, true));
  const auto read = read_noitom(bytes);
  CHECK(read.frames.size() == 3);
  CHECK(read.counts.bytes_skipped == 0);
}

TEST_CASE("noitom: a version that says nothing leaves it to count and flags") {
  for (const auto form : {NoitomForm::old_header, NoitomForm::new_header}) {
    const auto frame = noitom_frame(form, true, false);
    Bytes bytes = bytes_of(frame);
    for (std::size_t k = 2; k < 6; ++k) bytes[k] = 0x77;
    CHECK(read_noitom(bytes).frames == std::vector{frame});
  }
}

TEST_CASE("noitom: a version that speaks is believed") {
  Bytes bytes = bytes_of(noitom_frame(NoitomForm::old_header, false, false));
  bytes[4] = 1;  // 1.1: the old layout under the new header's version
  bytes[8] = 1;  // not a count of the new header
  bytes += Bytes(bytes);
  CHECK(read_noitom(bytes).counts[NoitomRefusal::wrong_count] == 1);
  CHECK(read_noitom(bytes).frames.empty());
}

TEST_CASE("noitom: rubbish of every kind in front costs no frame") {
  const auto frame = noitom_frame(NoitomForm::new_header, true, false);
  const auto text = noitom_frame(NoitomForm::text, false, false);
  const Bytes digits = bytes_of("17 and 4 | 5");
  for (const Bytes& rubbish : {repeated(0xff, 200), repeated(0xdd, 9), repeated('C', 30), digits,
                               Bytes{0xff, 0xdd}, Bytes{0xff, 0xdd, 0xff}, bytes_of("|| 1 || ")}) {
    for (const auto& good : {frame, text}) {
      Bytes bytes = rubbish;
      bytes.push_back(good.form == NoitomForm::text ? ' ' : '0');
      bytes += bytes_of(good);
      CHECK(read_noitom(bytes).frames == std::vector{good});
    }
  }
}

TEST_CASE("noitom: bytes that are in no frame are counted, each once") {
  Bytes bytes = repeated(0xff, 200);
  bytes += bytes_of(noitom_frame(NoitomForm::new_header, true, false));
  bytes += repeated('x', 50);
  CHECK(read_noitom(bytes).counts.bytes_skipped == 250);
}

TEST_CASE("noitom: FF DD among the floats begins no frame") {
  auto frame = noitom_frame(NoitomForm::new_header, true, false);
  frame.values[17] = std::bit_cast<float>(0x4040ddffU);  // bytes ff dd 40 40
  frame.values[100] = std::bit_cast<float>(0x40ddff40U);
  Bytes bytes = bytes_of(frame);
  // The receiver begins in the middle of a frame: the bytes after FF DD are no header.
  Bytes late(bytes.begin() + 70, bytes.end());
  late += bytes;
  CHECK(read_noitom(late).frames == std::vector{frame});
  CHECK(read_noitom(bytes).frames == std::vector{frame});
}

TEST_CASE("noitom: a wrong count swallows nothing behind it") {
  const auto frame = noitom_frame(NoitomForm::new_header, false, false);
  for (const unsigned count : {0U, 5U, 181U, 354U, 65535U}) {
    Bytes bytes = bytes_of(frame);
    bytes[6] = static_cast<std::uint8_t>(count);
    bytes[7] = static_cast<std::uint8_t>(count >> 8);
    bytes += bytes_of(frame);
    const auto read = read_noitom(bytes);
    CHECK(read.frames == std::vector{frame});
    CHECK(read.counts[NoitomRefusal::wrong_count] == 0);
    CHECK(read.counts[NoitomRefusal::garbage] == 1);  // no other frame begins at its end
  }
  Bytes bytes = bytes_of(frame);  // a count that its flag confirms, with fewer values
  bytes[6] = 354 & 0xff;
  bytes[7] = 354 >> 8;
  bytes[8] = 1;
  bytes += bytes_of(frame);
  bytes += bytes_of(frame);
  const auto read = read_noitom(bytes);
  CHECK(read.frames == std::vector{frame, frame});
  CHECK(read.counts[NoitomRefusal::incomplete] == 1);
}

TEST_CASE("noitom: a refused header swallows no header that begins within it") {
  auto frame = noitom_frame(NoitomForm::new_header, false, false);
  // Its end is, by chance, that of the header of 40 bytes before it.
  frame.name = "12345678\xff\xee";
  Bytes bytes(40, 1);
  bytes[0] = 0xff;
  bytes[1] = 0xdd;
  bytes += bytes_of(frame);
  const auto read = read_noitom(bytes);
  CHECK(read.frames == std::vector{frame});
  CHECK(read.counts[NoitomRefusal::garbage] == 1);
}

TEST_CASE("noitom: frames of another skeleton are of a wrong count, with what to do") {
  for (const std::size_t values : {66U, 126U, 366U, 1206U}) {
    for (const auto form : {NoitomForm::old_header, NoitomForm::new_header}) {
      CAPTURE(values);
      Bytes frame = bytes_of(noitom_frame(form, false, false));
      frame.resize(64 + 4 * values, 0x7c);  // the floats consist of bytes that end a text
      frame[6] = static_cast<std::uint8_t>(values);
      frame[7] = static_cast<std::uint8_t>(values >> 8);
      Bytes bytes;
      for (int k = 0; k < 5; ++k) bytes += frame;
      const auto good = noitom_frame(form, false, false);
      bytes += bytes_of(good);
      for (const std::size_t most : {bytes.size(), std::size_t{100}}) {
        const auto read = read_noitom(bytes, most);
        CHECK(read.counts[NoitomRefusal::wrong_count] == 5);
        CHECK(read.counts[NoitomRefusal::garbage] == 0);
        CHECK(read.frames == std::vector{good});
        REQUIRE(read.findings.size() == 1);
        CHECK(to_string(read.findings[0].what) ==
              "axis: expected 180, 186, 354 or 360 values in a frame, found wrong_count (5 times)");
        CHECK(read.findings[0].repair == "broadcast the 59 joints of Axis Neuron or Axis Studio");
      }
    }
  }
}

TEST_CASE("noitom: in rubbish no frame has a wrong count") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    Bytes bytes;
    for (int k = 0; k < 100'000; ++k) bytes.push_back(static_cast<std::uint8_t>(random()));
    for (std::size_t at = 100; at < bytes.size() - 64;
         at += 1001) {  // tokens, but never after whole floats
      bytes[at] = bytes[at + 62] = 0xff;
      bytes[at + 1] = 0xdd;
      bytes[at + 63] = 0xee;
    }
    const auto read = read_noitom(bytes, 5000, seed);
    CHECK(read.counts[NoitomRefusal::wrong_count] == 0);
    CHECK(read.counts[NoitomRefusal::garbage] >= 90);
    REQUIRE(!read.findings.empty());
    const auto of_garbage = std::find_if(
        read.findings.begin(), read.findings.end(),
        [](const Finding& f) { return f.what.expected == "frames of the BVH broadcast"; });
    REQUIRE(of_garbage != read.findings.end());
    CHECK(of_garbage->repair == "check that only the BVH broadcast is sent to this port");
  }
}

TEST_CASE("noitom: a header of rubbish holds no frame back") {
  const auto frame = noitom_frame(NoitomForm::new_header, false, false);
  Bytes bytes = bytes_of(frame);
  bytes[6] = 1200 & 0xff;
  bytes[7] = 1200 >> 8;
  bytes += bytes_of(frame);
  CHECK(read_noitom(bytes).frames == std::vector{frame});
}

TEST_CASE("noitom: a header without its end token is none") {
  Bytes bytes = bytes_of(noitom_frame(NoitomForm::new_header, false, false));
  bytes[63] = 0xef;
  const auto read = read_noitom(bytes);
  CHECK(read.frames.empty());
  CHECK(read.counts.refused == NoitomCounts{}.refused);
}

TEST_CASE("noitom: a lost piece costs its own frame alone, wherever it was") {
  const auto frame = noitom_frame(NoitomForm::new_header, true, false);
  const Bytes one = bytes_of(frame);
  for (std::size_t lost = 1; lost < one.size(); ++lost) {
    Bytes bytes(one.begin(), one.end() - static_cast<std::ptrdiff_t>(lost));
    for (int k = 0; k < 3; ++k) bytes += one;
    // The next frame's header ends the incomplete frame if at least ten of its bytes lie in its
    // room.
    const std::size_t fewest = lost < 10 ? 2 : 3;
    CAPTURE(lost);
    CHECK(read_noitom(bytes).frames.size() >= fewest);
  }
}

TEST_CASE("noitom: several avatars are counted each by its own index") {
  Bytes bytes;
  for (std::uint32_t k = 0; k < 10; ++k) {
    for (std::uint32_t avatar = 0; avatar < 2; ++avatar) {
      if (avatar == 1 && (k == 4 || k == 5)) continue;  // lost
      auto frame = noitom_frame(NoitomForm::new_header, false, false, 0xfffffffb + k);
      frame.avatar = avatar;
      frame.name = avatar == 0 ? "left" : "right";
      bytes += bytes_of(frame);
      if (avatar == 0 && k == 7) bytes += bytes_of(frame);  // doubled
    }
  }
  const auto read = read_noitom(bytes);
  CHECK(read.frames.size() == 19);
  CHECK(read.avatars.at(0).name == "left");
  CHECK(read.avatars.at(0).by_index.counts() == SequenceCounts{11, 0, 0, 1, 0, 0});
  CHECK(read.avatars.at(1).by_index.counts() == SequenceCounts{8, 2, 0, 0, 0, 0});
  CHECK(std::count(read.orders.begin(), read.orders.end(), Order::duplicate) == 1);
}

TEST_CASE("noitom: a sender can't make us hold more than 64 avatars") {
  NoitomDecoder decoder;
  std::vector<NoitomArrival> arrivals;
  for (std::uint32_t avatar = 0; avatar < 100; ++avatar) {
    auto frame = noitom_frame(NoitomForm::new_header, false, false);
    frame.avatar = avatar * 977;
    decoder.feed(bytes_of(frame), arrivals);
  }
  CHECK(decoder.avatars().size() == 64);
  CHECK(decoder.counts()[NoitomRefusal::too_many_avatars] == 36);
  CHECK(arrivals.size() == 64);
}

TEST_CASE("noitom: Axis Studio's compressed port is refused with what to do") {
  Bytes bytes = bytes_of("CCCC");
  bytes += {40, 0, 0, 0, 0x1f, 0x8b, 8, 0};
  bytes += repeated(0x5a, 36);
  const auto read = read_noitom(bytes);
  CHECK(read.frames.empty());
  CHECK(read.counts[NoitomRefusal::compressed] == 1);
  REQUIRE(read.findings.size() == 1);
  CHECK(to_string(read.findings[0].what) ==
        "axis: expected plain BVH frames, found compressed (once)");
  CHECK(read.findings[0].repair ==
        "switch the capture program to plain BVH broadcast (binary or string, no compression)");
}

TEST_CASE("noitom: the old compressed mode is refused and swallows nothing") {
  Bytes bytes = bytes_of(noitom_frame(NoitomForm::old_header, true, false));
  bytes[54] = 1;
  bytes.resize(400);
  const auto good = noitom_frame(NoitomForm::old_header, true, false);
  bytes += bytes_of(good);
  const auto read = read_noitom(bytes);
  CHECK(read.frames == std::vector{good});
  CHECK(read.counts[NoitomRefusal::compressed] == 1);
}

TEST_CASE("noitom: the calculation stream and the command channel are recognised") {
  Bytes bytes = other_header(0x88, 0x99);
  bytes += repeated(0, 512);
  bytes += other_header(0xaa, 0xbb);
  const auto good = noitom_frame(NoitomForm::new_header, true, false);
  bytes += bytes_of(good);
  const auto read = read_noitom(bytes);
  CHECK(read.counts[NoitomRefusal::calculation] == 1);
  CHECK(read.counts[NoitomRefusal::command] == 1);
  CHECK(read.frames == std::vector{good});
  REQUIRE(read.findings.size() == 2);
  CHECK(read.findings[0].meaning == "this is the calculation stream (0x88FF)");
}

TEST_CASE("noitom: text of another length, without numbers or without an end is refused") {
  CHECK(read_noitom(bytes_of("0 Char00 1 2 3 ||")).counts[NoitomRefusal::wrong_count] == 1);
  std::string words = "0 Char00";
  for (int k = 0; k < 180; ++k) words += k == 90 ? " x" : " 1.5";
  CHECK(read_noitom(bytes_of(words + " ||")).counts[NoitomRefusal::wrong_count] == 0);
  CHECK(read_noitom(bytes_of(words + " ||")).counts[NoitomRefusal::garbage] == 1);
  Bytes endless = bytes_of("0 Char00");
  for (int k = 0; k < 20'000; ++k) endless += bytes_of(" 1");
  endless += bytes_of(" || ");
  const auto good = noitom_frame(NoitomForm::text, false, false);
  endless += bytes_of(good);
  const auto read = read_noitom(endless);
  CHECK(read.counts[NoitomRefusal::too_long] == 2);
  CHECK(read.frames == std::vector{good});
}

TEST_CASE("noitom: words that are no frame's are garbage, of whatever number they are") {
  for (const char* const words :
       {"17 and 4 ||", "0.5 Char00 1 2 3 ||", "0 Char00 ||", "0 Char00 1 2 ||", "0 1 Char00 ||",
        "7 a 1 b 2 c 3 ||", "0 Char|00 1 2 3 ||", "0 Char00 1 2 inf ||"}) {
    CAPTURE(words);
    const auto read = read_noitom(bytes_of(words));
    CHECK(read.counts[NoitomRefusal::wrong_count] == 0);
    CHECK(read.counts[NoitomRefusal::garbage] == 1);
  }
}

TEST_CASE("noitom: the end of a frame is nothing where a stream is come into, garbage within it") {
  const auto good = noitom_frame(NoitomForm::text, false, false);
  Bytes bytes = bytes_of("1.5 2.5 ||");
  bytes += bytes_of(good);
  CHECK(read_noitom(bytes).findings.empty());
  CHECK(read_noitom(bytes).frames == std::vector{good});
  bytes += bytes_of("1.5 2.5 ||");
  CHECK(read_noitom(bytes).counts[NoitomRefusal::garbage] == 1);
}

TEST_CASE("noitom: a text that lost its end passes over to the next") {
  const auto good = noitom_frame(NoitomForm::text, false, false);
  Bytes bytes = bytes_of("0 Char00 1.5 2.5 ");
  bytes += bytes_of(good);
  CHECK(read_noitom(bytes).frames == std::vector{good});
}
