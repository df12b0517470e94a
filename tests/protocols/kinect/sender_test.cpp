// SPDX-License-Identifier: Apache-2.0
// The Windows sender's C# (tools/kinect_sender) compared with our code: its constants in every run,
// its bytes if Mono is there to compile it.
#include "tests/folder.h"
#include "tests/protocols/kinect/kinect_messages.h"

#include "kinalign/protocols/kinect/stream.h"
#include "kinalign/wire/hex.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <regex>
#include <sstream>

using namespace kinalign;

namespace {

const std::string sender = KINALIGN_SOURCE_DIR "/tools/kinect_sender/";

/// The value of `name = 123` among the constants of class Layout.
std::uint64_t constant(const std::string& name) {
  static const std::string source = bytes_in(sender + "KinectMessages.cs");
  std::smatch found;
  REQUIRE_MESSAGE(
      std::regex_search(source, found, std::regex("\\b" + name + " = (0x[0-9a-f]+|[0-9]+)[,;]")),
      name);
  return std::stoull(found[1], nullptr, 0);
}

bool has_mono() { return std::system("command -v mcs mono > /dev/null 2>&1") == 0; }

/// Writes one message a line, hexadecimal.
const char* const program = R"(
using System; using System.Text; using Kinalign;
static class Test {
  static void Say(byte[] b) { Console.WriteLine(BitConverter.ToString(b).Replace("-", "")); }
  static void Say(string line) { Say(Encoding.UTF8.GetBytes(line)); }
  static Frame Made(int bodies, bool more) {
    var frame = new Frame { Sequence = 1000, DeviceTicks = 10000000, TakenTicks = 123456789,
      UtcMicroseconds = 1790000000000000, Orientations = more, Hands = more };
    if (more) frame.Floor = new float[] { 0, 1, 0, 0.75f };
    for (int i = 0; i < bodies; ++i) {
      var body = new Body { Id = 0xfedcba9876543210UL + (ulong)i, ClippedEdges = 8, HandLeft = 2, HandRight = 4, HandConfidence = 2 };
      for (int j = 0; j < 25; ++j) body.States[j] = (byte)(j % 3);
      for (int k = 0; k < 75; ++k) body.Positions[k] = k / 7.0f - i;
      for (int k = 0; k < 100; ++k) body.Orientations[k] = (k + 1) / 3.0f;
      frame.Bodies.Add(body);
    }
    return frame;
  }
  static void Main() {
    var messages = new Messages(2, 0x5eedf00d);
    var echo = new Echo { PongSequence = 41, Nonce = 0x1badcafe, ReceivedTicks = 100000000 };
    Say(messages.Hello(3, "00\"12", "2.0.1410.0")); Say(messages.HelloLine(3, "00\"12", "2.0.1410.0"));
    Say(messages.Ping(42, 123456789, echo)); Say(messages.PingLine(42, 123456789, echo));
    Say(messages.Ping(0, 5, null)); Say(messages.PingLine(0, 5, null));
    Say(messages.FramePart(Made(0, true), 0, 0, 0, false, 123466789)); Say(messages.FrameLine(Made(0, true), 123466789));
    Say(messages.FramePart(Made(4, false), 0, 4, 0, false, 123466789)); Say(messages.FrameLine(Made(4, false), 123466789));
    Say(messages.FramePart(Made(1, true), 0, 1, 0, false, 123466789)); Say(messages.FrameLine(Made(1, true), 123466789));
    byte[] pong = Convert.FromBase64String(PONG);
    Echo heard = messages.ReadPong(pong, pong.Length, 7);
    Echo line = messages.ReadPongLine(PONG_LINE, 8);
    pong[24] ^= 1;
    Console.WriteLine(heard.PongSequence + " " + heard.Nonce + " " + heard.ReceivedTicks + " " + line.PongSequence + " " +
      line.Nonce + " " + (messages.ReadPong(pong, pong.Length, 7) == null) + " " + Messages.BodiesInPart(Made(1, false)) + Messages.BodiesInPart(Made(1, true)));
  }
}
)";

KinectFrame made(std::size_t bodies, bool more) {
  KinectFrame frame;
  frame.origin = {2, 0x5eedf00d, 1000};
  frame.device_ticks = 10'000'000;
  frame.taken_ticks = 123'456'789;
  frame.sent_ticks = 123'466'789;
  frame.utc_us = 1'790'000'000'000'000;
  frame.has_hands = frame.has_orientations = more && bodies > 0;
  if (more) frame.floor = {0.0F, 1.0F, 0.0F, 0.75F};
  for (std::size_t i = 0; i < bodies; ++i) {
    KinectBody& body = frame.bodies.emplace_back();
    body.id = 0xfedcba9876543210 + i;
    body.clipped_edges = 8;
    if (more) {
      body.hand_left = 2;
      body.hand_right = 4;
      body.hand_confidence = 2;
    }
    for (std::size_t j = 0; j < 25; ++j) body.states[j] = static_cast<std::uint8_t>(j % 3);
    for (std::size_t k = 0; k < 75; ++k) {
      body.positions[k] = static_cast<float>(k) / 7.0F - static_cast<float>(i);
    }
    for (std::size_t k = 0; more && k < 100; ++k) {
      body.orientations[k] = static_cast<float>(k + 1) / 3.0F;
    }
  }
  return frame;
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t at = 0; at + 2 < bytes.size(); at += 3) {  // the size is a multiple of 3
    const unsigned three = bytes[at] * 65'536U + bytes[at + 1] * 256U + bytes[at + 2];
    for (int shift = 18; shift >= 0; shift -= 6) out += digits[three >> shift & 63];
  }
  return out;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

}  // namespace

TEST_CASE("the sender's numbers are the layout's") {
  CHECK(constant("Magic") == 0x4b4e414b);  // little-endian: 4b 41 4e 4b
  CHECK(constant("Joints") == kinect_joints.size());
  CHECK(constant("HeadSize") == kinect_head_size);
  CHECK(constant("CrcSize") == kinect_crc_size);
  CHECK(constant("FrameFieldsSize") ==
        kinect_frame_size(0, false) - kinect_head_size - kinect_crc_size);
  CHECK(constant("MostDatagram") == most_kinect_datagram);
  CHECK(constant("MostBodies") == most_kinect_bodies);
  CHECK(constant("LeastPingLine") == least_kinect_ping_line);
  CHECK(constant("PongSize") == encode_kinect_binary(KinectPong{}).size());
  const auto type = [](const KinectMessage& message) { return encode_kinect_binary(message)[5]; };
  CHECK(constant("HelloType") == type(KinectHello{}));
  CHECK(constant("FrameType") == type(KinectFrame{}));
  CHECK(constant("PingType") == type(KinectPing{}));
  CHECK(constant("PongType") == type(KinectPong{}));
  CHECK(constant("Version") == encode_kinect_binary(KinectPong{})[4]);
  CHECK(constant("KinectV2") == encode_kinect_binary(KinectHello{})[21]);
  KinectFrame frame = made(1, true);
  frame.more_parts = true;
  std::uint64_t flags = 0;
  for (const char* flag :
       {"UtcFlag", "FloorFlag", "OrientationsFlag", "HandsFlag", "MorePartsFlag"}) {
    flags |= constant(flag);
  }
  CHECK(flags == encode_kinect_binary(frame)[20]);
  CHECK(constant("EchoFlag") == encode_kinect_binary(KinectPing{{}, 0, KinectEcho{}})[20]);
  // 12 + Joints + 12 * Joints, 16 * Joints: the sizes that the source computes.
  CHECK(kinect_frame_size(1, false) - kinect_frame_size(0, false) == 12 + 25 + 12 * 25);
  CHECK(kinect_frame_size(1, true) - kinect_frame_size(1, false) == 16 * 25);
}

TEST_CASE("the sender's C# writes the bytes that we write" * doctest::description("needs mono") *
          doctest::skip(!has_mono())) {
  const FreshFolder folder;
  const KinectPong pong{{2, 0x5eedf00d, 42}, 43, 0xdeadbeef};
  std::string line = encode_kinect_line(pong);
  line.pop_back();
  std::string text = replaced(program, "PONG)", '"' + base64(encode_kinect_binary(pong)) + "\")");
  text =
      replaced(text, "PONG_LINE", "@\"" + std::regex_replace(line, std::regex("\""), "\"\"") + '"');
  folder.write("Test.cs", text);
  const std::string command = "cd '" + folder.path() +
                              "' && mcs -langversion:5 -out:Test.exe Test.cs " + sender +
                              "KinectMessages.cs && mono Test.exe > said";
  REQUIRE(std::system(command.c_str()) == 0);
  const std::vector<KinectMessage> messages{
      KinectHello{{2, 0x5eedf00d, 3}, "00\"12", "2.0.1410.0"},
      KinectPing{{2, 0x5eedf00d, 42}, 123'456'789, KinectEcho{41, 0x1badcafe, 100'000'000}},
      KinectPing{{2, 0x5eedf00d, 0}, 5, std::nullopt},
      made(0, true),
      made(4, false),
      made(1, true)};
  std::istringstream said(folder.read("said"));
  for (std::size_t i = 0; i < messages.size(); ++i) {
    CAPTURE(i);
    for (const bool is_line : {false, true}) {
      CAPTURE(is_line);
      std::string digits;
      std::getline(said, digits);
      std::vector<std::uint8_t> bytes(digits.size() / 2);
      REQUIRE(take_hex(digits, bytes));
      KinectMessage read;
      REQUIRE(decode_kinect_datagram(bytes, read) == KinectRefusal::none);
      CHECK(bytes[0] == (is_line ? '{' : 'K'));
      CHECK(encode_kinect_binary(read) == encode_kinect_binary(messages[i]));
    }
  }
  std::string rest;
  std::getline(said, rest);
  CHECK(rest == "43 3735928559 7 43 3735928559 True 41");
}
