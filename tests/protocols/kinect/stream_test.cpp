// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/kinect/stream.h"

#include "tests/page_bytes.h"
#include "tests/protocols/kinect/kinect_messages.h"
#include "tests/seeds.h"

#include "kinalign/wire/crc32.h"

#include <doctest/doctest.h>

#include <functional>
#include <limits>

using namespace kinalign;

namespace {

using Bytes = std::vector<std::uint8_t>;
using Refusal = KinectRefusal;

constexpr KinectOrigin page_origin{2, 0x5eedf00d, 42};

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

/// The bytes with the right CRC at their end.
Bytes sealed(Bytes bytes) {
  const std::uint32_t crc = crc32(std::span(bytes).first(bytes.size() - 4));
  for (std::size_t i = 0; i < 4; ++i) {
    bytes[bytes.size() - 4 + i] = static_cast<std::uint8_t>(crc >> (8 * i));
  }
  return bytes;
}

Refusal refusal_of(const Bytes& datagram) {
  KinectMessage message;
  const Refusal refusal = decode_kinect_datagram(datagram, message);
  if (refusal != Refusal::none) CHECK(message.index() == 0);  // the message is unchanged
  return refusal;
}
Refusal refusal_of(const std::string& line) { return refusal_of(bytes_of(line)); }

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  REQUIRE(text.find(from) != std::string::npos);
  return text.replace(text.find(from), from.size(), to);
}

KinectFrame page_frame() {
  KinectFrame frame;
  frame.origin = {2, 0x5eedf00d, 1000};
  frame.device_ticks = 10'000'000;
  frame.taken_ticks = 123'456'789;
  frame.sent_ticks = 123'466'789;
  frame.utc_us = 1'790'000'000'000'000;
  frame.floor = {0.0F, 1.0F, 0.0F, 0.75F};
  return frame;
}

std::string page_line() {
  const std::string page = bytes_in(KINALIGN_SOURCE_DIR "/docs/formats/kinect_stream_example.md");
  const auto begin = page.find("```json\n") + 8;
  return page.substr(begin, page.find('\n', begin) + 1 - begin);
}

struct Heard {
  std::vector<Bytes> messages;  // encoded again
  KinectStreamCounts counts;

  bool operator==(const Heard&) const = default;
};

Heard hear(const Bytes& stream, const std::function<std::size_t()>& piece) {
  KinectStreamDecoder decoder;
  std::vector<KinectMessage> out;
  for (std::size_t at = 0; at < stream.size();) {
    const std::size_t size = std::min(std::max<std::size_t>(piece(), 1), stream.size() - at);
    decoder.feed(std::span(stream).subspan(at, size), out);
    at += size;
  }
  decoder.finish(out);
  Heard heard{{}, decoder.counts()};
  for (const auto& message : out) heard.messages.push_back(encode_kinect_binary(message));
  return heard;
}

Heard hear(const Bytes& stream) {
  return hear(stream, [&stream] { return stream.size(); });
}

std::uint64_t refused(const Heard& heard, Refusal refusal) {
  return heard.counts.refused[static_cast<std::size_t>(refusal)];
}

struct Stream {
  Bytes bytes;
  std::vector<std::size_t> starts;
};

Stream random_stream(std::mt19937_64& random, std::size_t messages, bool lines) {
  Stream stream;
  for (std::size_t i = 0; i < messages; ++i) {
    const auto message = any_message(random);
    const Bytes one = lines ? bytes_of(encode_kinect_line(message)) : encode_kinect_binary(message);
    stream.starts.push_back(stream.bytes.size());
    stream.bytes.insert(stream.bytes.end(), one.begin(), one.end());
  }
  return stream;
}

}  // namespace

TEST_CASE("the page's messages of a Kinect are what we send") {
  const auto page = [](const char* name) {
    return bytes_of_page("kinect_stream_example.md", name);
  };
  const KinectHello hello{{2, 0x5eedf00d, 3}, "001265", "2.0.1410.0"};
  const KinectPing ping{page_origin, 123'456'789, KinectEcho{41, 0x1badcafe, 100'000'000}};
  CHECK(encode_kinect_binary(hello) == page("hello"));
  CHECK(encode_kinect_binary(ping) == page("ping"));
  CHECK(encode_kinect_binary(KinectPong{page_origin, 42, 0xdeadbeef}) == page("pong"));
  CHECK(encode_kinect_binary(page_frame()) == page("frame"));
  CHECK(encode_kinect_line(page_frame()) == page_line());
}

TEST_CASE("the page's messages of a Kinect are what we read") {
  for (const char* name : {"hello", "ping", "pong", "frame"}) {
    KinectMessage message;
    const Bytes bytes = bytes_of_page("kinect_stream_example.md", name);
    REQUIRE(decode_kinect_datagram(bytes, message) == Refusal::none);
    CHECK(encode_kinect_binary(message) == bytes);
  }
}

TEST_CASE("a body's bytes stand where the page says") {
  // By hand: head 24, frame 48, body 12 + 25 states + 300 + 400, CRC 4.
  KinectFrame frame = frame_of(1, {0x0102030405060708});
  frame.has_orientations = frame.has_hands = true;
  KinectBody& body = frame.bodies[0];
  body.clipped_edges = 8;
  body.hand_left = 2;
  body.hand_right = 3;
  body.hand_confidence = 1;
  body.states[24] = 1;
  body.positions[3 * 24 + 2] = 1.0F;
  body.orientations[4 * 24] = -2.0F;
  const Bytes bytes = encode_kinect_binary(frame);
  REQUIRE(bytes.size() == 24 + 48 + 737 + 4);
  CHECK(bytes[20] == 4 + 8);
  CHECK(bytes[22] == 1);
  CHECK(Bytes(bytes.begin() + 72, bytes.begin() + 84) == Bytes{8, 7, 6, 5, 4, 3, 2, 1, 8, 2, 3, 1});
  CHECK(bytes[84 + 24] == 1);
  CHECK(Bytes(bytes.begin() + 109 + 296, bytes.begin() + 109 + 300) == Bytes{0, 0, 0x80, 0x3f});
  CHECK(Bytes(bytes.begin() + 409 + 384, bytes.begin() + 409 + 388) == Bytes{0, 0, 0, 0xc0});
}

TEST_CASE("both encodings say the same, bit for bit") {
  for (const auto seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Bytes binary = encode_kinect_binary(any_message(random));
    KinectMessage message;
    REQUIRE(decode_kinect_datagram(binary, message) == Refusal::none);
    const std::string line = encode_kinect_line(message);
    REQUIRE(decode_kinect_datagram(bytes_of(line), message) == Refusal::none);
    CHECK(encode_kinect_binary(message) == binary);
    CHECK(line.size() <= most_kinect_line);
    CHECK(line.find('\n') == line.size() - 1);
  }
}

TEST_CASE("a joint that is not finite is null in a line and NaN again") {
  KinectFrame frame = frame_of(1, {1});
  frame.bodies[0].positions[0] = std::numeric_limits<float>::infinity();
  const std::string line = encode_kinect_line(frame);
  CHECK(line.find("[[null,1,1],") != std::string::npos);
  KinectMessage message;
  REQUIRE(decode_kinect_line(line, message) == Refusal::none);
  const float x = std::get<KinectFrame>(message).bodies[0].positions[0];
  CHECK(x != x);
}

TEST_CASE("a line written by another program is read: blanks, order of keys, unknown keys") {
  KinectMessage message;
  const std::string line =
      R"( { "more": [1, {"a": null}], "type": "pong", "nonce": 5, "pong_sequence": 4, )"
      R"("sequence": 3, "session": 2, "sensor": 1, "schema": "kinalign.kinect/1" } )";
  REQUIRE(decode_kinect_line(line, message) == Refusal::none);
  CHECK(encode_kinect_binary(message) == encode_kinect_binary(KinectPong{{1, 2, 3}, 4, 5}));
}

TEST_CASE("a pong is never longer than its ping") {
  const KinectPong longest{{UINT32_MAX, UINT32_MAX, UINT32_MAX}, UINT32_MAX, UINT32_MAX};
  const KinectPing shortest{};
  CHECK(encode_kinect_line(longest).size() <= encode_kinect_line(shortest).size());
  CHECK(encode_kinect_line(shortest).size() == least_kinect_ping_line);
  CHECK(encode_kinect_binary(longest).size() <= encode_kinect_binary(shortest).size());
  std::string line = encode_kinect_line(shortest);
  line.pop_back();
  CHECK(refusal_of(line) == Refusal::none);  // in a datagram the line end may be missing
  line.pop_back();
  CHECK(refusal_of(line) == Refusal::too_short);
}

TEST_CASE("each fault of a binary message has its name") {
  const Bytes good = encode_kinect_binary(page_frame());
  const auto with = [&good](std::size_t at, std::uint8_t byte) {
    Bytes bytes = good;
    bytes[at] = byte;
    return sealed(bytes);
  };
  CHECK(refusal_of(Bytes{}) == Refusal::too_short);
  CHECK(refusal_of(Bytes(good.begin(), good.begin() + 27)) == Refusal::too_short);
  CHECK(refusal_of(with(0, 'k')) == Refusal::no_message);
  CHECK(refusal_of(with(4, 2)) == Refusal::unknown_version);
  CHECK(refusal_of(with(6, 77)) == Refusal::wrong_length);
  Bytes damaged = good;
  damaged[40] ^= 1;
  CHECK(refusal_of(damaged) == Refusal::bad_crc);
  CHECK(refusal_of(with(5, 5)) == Refusal::unknown_type);
  CHECK(refusal_of(with(5, 0)) == Refusal::unknown_type);
  CHECK(refusal_of(with(21, 2)) == Refusal::unknown_joint_set);
  CHECK(refusal_of(with(20, 32 + 3)) == Refusal::reserved_bits);
  CHECK(refusal_of(with(20, 2)) == Refusal::reserved_bits);      // UTC without its flag
  CHECK(refusal_of(with(20, 1)) == Refusal::reserved_bits);      // the floor without its flag
  CHECK(refusal_of(with(20, 3 + 8)) == Refusal::reserved_bits);  // hands of nobody
  CHECK(refusal_of(with(22, 1)) == Refusal::wrong_length);
  CHECK(refusal_of(with(22, 7)) == Refusal::wrong_fields);
  CHECK(refusal_of(with(23, 6)) == Refusal::wrong_fields);
  CHECK(refusal_of(with(31, 0x20)) == Refusal::wrong_fields);  // 2^61 ticks
  CHECK(refusal_of(with(39, 0x20)) == Refusal::wrong_fields);
  CHECK(refusal_of(with(47, 0x20)) == Refusal::wrong_fields);
  CHECK(refusal_of(with(55, 0x20)) == Refusal::wrong_fields);
  CHECK(refusal_of(with(55, 0x80)) == Refusal::wrong_fields);
  Bytes too_long(4499);
  std::copy(good.begin(), good.begin() + 24, too_long.begin());
  CHECK(refusal_of(too_long) == Refusal::too_long);
}

TEST_CASE("stray bits of bodies, hellos and pings have their name") {
  const Bytes body = encode_kinect_binary(frame_of(1, {1}));
  for (const auto& [at, byte] : std::vector<std::pair<std::size_t, std::uint8_t>>{
           {80, 16}, {81, 1}, {82, 1}, {83, 1}, {84, 3}, {108, 3}}) {
    CAPTURE(at);
    Bytes bytes = body;
    bytes[at] = byte;
    CHECK(refusal_of(sealed(bytes)) == Refusal::reserved_bits);
  }
  const Bytes hello = encode_kinect_binary(KinectHello{page_origin, "1", "2"});
  const Bytes ping = encode_kinect_binary(KinectPing{page_origin, 1, std::nullopt});
  const Bytes pong = encode_kinect_binary(KinectPong{page_origin, 1, 2});
  for (const std::size_t at : {20U, 22U, 23U}) {
    CAPTURE(at);
    for (Bytes bytes : {hello, ping, pong}) {
      bytes[at] = 2;
      CHECK(refusal_of(sealed(bytes)) == Refusal::reserved_bits);
    }
  }
  for (Bytes bytes : {ping, pong}) {
    bytes[21] = 1;
    CHECK(refusal_of(sealed(bytes)) == Refusal::reserved_bits);
  }
  Bytes echo = ping;
  echo[36] = 1;  // a nonce without its flag
  CHECK(refusal_of(sealed(echo)) == Refusal::reserved_bits);
  Bytes text = hello;
  text[25] = 0x1b;
  CHECK(refusal_of(sealed(text)) == Refusal::wrong_fields);
  text[24] = 200;  // longer than the message
  CHECK(refusal_of(sealed(text)) == Refusal::wrong_length);
}

TEST_CASE("each fault of a line has its name") {
  KinectFrame frame = frame_of(1, {1, 2});
  frame.has_hands = true;
  frame.floor = {0.0F, 1.0F, 0.0F, 0.5F};
  const std::string good = encode_kinect_line(frame);
  REQUIRE(refusal_of(good) == Refusal::none);
  const auto with = [&good](const std::string& from, const std::string& to) {
    return refusal_of(replaced(good, from, to));
  };
  CHECK(refusal_of(std::string("[1]")) == Refusal::no_message);
  CHECK(refusal_of(good.substr(0, good.size() - 2)) == Refusal::bad_json);
  CHECK(with("kinect/1", "kinect/2") == Refusal::unknown_version);
  CHECK(with("\"schema\":\"kinalign.kinect/1\"", "\"schema\":1") == Refusal::wrong_fields);
  CHECK(with("\"frame\"", "\"flame\"") == Refusal::unknown_type);
  CHECK(with("kinect_v2", "k4abt") == Refusal::unknown_joint_set);
  CHECK(with("\"sensor\":2", "\"sensor\":-2") == Refusal::wrong_fields);
  CHECK(with("\"sensor\":2", "\"sensor\":2.0") == Refusal::wrong_fields);
  CHECK(with("\"session\":77", "\"session\":4294967296") == Refusal::wrong_fields);
  CHECK(with("\"session\":77,", "") == Refusal::wrong_fields);
  CHECK(with("\"device_ticks\":334333", "\"device_ticks\":9007199254740992") ==
        Refusal::wrong_fields);
  CHECK(with("\"device_ticks\":334333", "\"device_ticks\":18446744073709551615") ==
        Refusal::wrong_fields);
  CHECK(with("[0,1,0,0.5]", "[0,1,0]") == Refusal::wrong_fields);
  CHECK(with("[0,1,0,0.5]", "[0,1,0,1e39]") == Refusal::wrong_fields);
  CHECK(with("[0,1,0,0.5]", "[0,1,0,1e999]") == Refusal::bad_json);
  CHECK(with("[0,1,0,0.5]", "[0,1,0,\"0.5\"]") == Refusal::wrong_fields);
  CHECK(with("\"id\":\"1\"", "\"id\":1") == Refusal::wrong_fields);
  CHECK(with("\"id\":\"1\"", "\"id\":\"1x\"") == Refusal::wrong_fields);
  CHECK(with("\"id\":\"1\"", "\"id\":\"18446744073709551616\"") == Refusal::wrong_fields);
  CHECK(with(",\"hands\":[0,0,0]", "") == Refusal::wrong_fields);  // one body alone has no hands
  frame.has_orientations = true;
  const std::string turned = encode_kinect_line(frame);
  const auto from = turned.find(",\"orientations\""), to = turned.find("]]", from);
  CHECK(refusal_of(turned.substr(0, from) + turned.substr(to + 2)) == Refusal::wrong_fields);
  CHECK(with("\"hands\":[0,0,0]", "\"hands\":[0,5,0]") == Refusal::reserved_bits);
  CHECK(with("\"states\":[2,", "\"states\":[3,") == Refusal::reserved_bits);
  CHECK(with("\"states\":[2,", "\"states\":[2,2,") == Refusal::wrong_fields);
  CHECK(with("\"positions\":[[1,", "\"positions\":[[") == Refusal::wrong_fields);
  CHECK(with("\"more_parts\":false", "\"more_parts\":0") == Refusal::wrong_fields);
  CHECK(with("\"part\":0", "\"part\":6") == Refusal::wrong_fields);
  CHECK(refusal_of("{" + std::string(most_kinect_line, ' ')) == Refusal::too_long);
  CHECK(refusal_of(std::string(most_kinect_line, '{')) == Refusal::bad_json);
}

TEST_CASE("a connection's messages do not depend on where it is cut") {
  for (const auto seed : fresh_seeds(60)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const bool lines = random() % 2 == 0;
    Stream stream = random_stream(random, 20, lines);
    const bool damaged = random() % 2 == 0;
    for (int i = 0; damaged && i < 5; ++i) {
      stream.bytes[random() % stream.bytes.size()] = static_cast<std::uint8_t>(random());
    }
    const Heard whole = hear(stream.bytes);
    const Heard cut = hear(stream.bytes, [&random] { return random() % 100; });
    CHECK(whole == cut);
    if (!damaged) CHECK(whole.counts.messages == 20);
    if (!damaged) CHECK(whole.counts.skipped_bytes == 0);
  }
}

TEST_CASE("a byte that is gone or too many costs two binary messages at most, or one line") {
  for (const auto seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const bool lines = random() % 2 == 0;
    Stream stream = random_stream(random, 12, lines);
    const auto at = static_cast<std::ptrdiff_t>(random() % stream.bytes.size());
    if (random() % 2 == 0) {
      // Without it two lines are joined.
      if (lines && stream.bytes[static_cast<std::size_t>(at)] == '\n') continue;
      stream.bytes.erase(stream.bytes.begin() + at);
    } else {
      stream.bytes.insert(stream.bytes.begin() + at,
                          static_cast<std::uint8_t>((random() | 0x80) & 0xff));
    }
    const Heard heard = hear(stream.bytes);
    CHECK(heard.counts.messages + (lines ? 1 : 2) >= 12);
  }
}

TEST_CASE("what is no message before, between and behind binary messages is skipped and counted") {
  const Bytes ping = encode_kinect_binary(KinectPing{page_origin, 1, std::nullopt});
  Bytes stream{'x', 'K', 'A'};
  stream.insert(stream.end(), ping.begin(), ping.end());
  stream.insert(stream.end(), {'K', 'A', 'N', '{', '\n'});
  stream.insert(stream.end(), ping.begin(), ping.end());
  stream.insert(stream.end(), {0x4b, 0x41, 0x4e, 0x4b, 1});
  const Heard heard = hear(stream);
  CHECK(heard.counts.messages == 2);
  CHECK(refused(heard, Refusal::no_message) == 2);
  CHECK(refused(heard, Refusal::too_short) == 1);
  CHECK(heard.counts.skipped_bytes == 3 + 5 + 5);
}

TEST_CASE("a length that no message has is passed over, and nothing waits for it") {
  const Bytes ping = encode_kinect_binary(KinectPing{page_origin, 1, std::nullopt});
  for (const std::uint8_t high : Bytes{0x00, 0xff}) {
    Bytes stream = ping;
    stream[6] = 3;
    stream[7] = high;
    stream.insert(stream.end(), ping.begin(), ping.end());
    const Heard heard = hear(stream);
    CHECK(heard.counts.messages == 1);
    CHECK(refused(heard, high == 0 ? Refusal::wrong_length : Refusal::too_long) == 1);
  }
}

TEST_CASE("a head that can't be swallows nothing behind it, whatever length it states") {
  const Bytes ping = encode_kinect_binary(KinectPing{page_origin, 1, std::nullopt});
  const auto heard_behind = [&ping](std::size_t at, std::uint8_t byte) {
    Bytes stream = ping;
    stream[at] = byte;
    stream[6] = 0x90;  // 4240 bytes
    stream[7] = 0x10;
    for (int i = 0; i < 100; ++i) stream.insert(stream.end(), ping.begin(), ping.end());
    return hear(stream);
  };
  const Heard newer = heard_behind(4, 2), long_ping = heard_behind(4, 1),
              no_type = heard_behind(5, 9);
  CHECK(newer.counts.messages == 100);
  CHECK(refused(newer, Refusal::unknown_version) == 1);
  CHECK(long_ping.counts.messages == 100);
  CHECK(refused(long_ping, Refusal::wrong_length) == 1);
  CHECK(no_type.counts.messages == 100);
  CHECK(refused(no_type, Refusal::unknown_type) == 1);
}

TEST_CASE("a message with more behind it than its type has is of a wrong length") {
  Bytes ping = encode_kinect_binary(KinectPing{page_origin, 1, std::nullopt});
  ping.resize(56);
  ping[6] = 56;
  CHECK(refusal_of(sealed(ping)) == Refusal::wrong_length);
}

TEST_CASE("a zero keeps its sign in a line") {
  KinectFrame frame = frame_of(1, {1});
  frame.bodies[0].positions[0] = -0.0F;
  KinectMessage message;
  REQUIRE(decode_kinect_line(encode_kinect_line(frame), message) == Refusal::none);
  CHECK(encode_kinect_binary(message) == encode_kinect_binary(frame));
}

TEST_CASE("a line without end is dropped once, and its memory with it") {
  const std::string pong = encode_kinect_line(KinectPong{page_origin, 1, 2});
  const Bytes stream = bytes_of(pong + std::string(300'000, 'a') + "\n\r\n" + pong +
                                pong.substr(0, pong.size() - 1));
  const Heard heard = hear(stream, [] { return 1000U; });
  CHECK(heard == hear(stream));
  CHECK(heard.counts.messages == 3);  // the last message has no end
  CHECK(refused(heard, Refusal::too_long) == 1);
  CHECK(heard.counts.skipped_bytes == 300'000);
}

TEST_CASE("the first byte that is no blank tells lines from binary") {
  std::vector<KinectMessage> out;
  KinectStreamDecoder lines, binary;
  lines.feed(bytes_of("\r\n {"), out);
  KinectStreamDecoder rubbish, rubbish_line;
  rubbish.feed(bytes_of("abc{KANK"), out);
  CHECK(!rubbish.speaks_lines());
  rubbish_line.feed(bytes_of("abc\n{"), out);
  CHECK(rubbish_line.speaks_lines());
  CHECK(lines.speaks_lines());
  binary.feed(bytes_of(" KANK"), out);
  CHECK(!binary.speaks_lines());
}

TEST_CASE("refusals have their names") {
  CHECK(std::string(name_of(Refusal::none)) == "none");
  CHECK(std::string(name_of(Refusal::bad_crc)) == "bad_crc");
  CHECK(std::string(name_of(Refusal::wrong_fields)) == "wrong_fields");
}
