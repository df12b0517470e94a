// SPDX-License-Identifier: Apache-2.0
// Any recording has sound rows: arrays of one length, stamps and times in their limits, unit
// rotations, and the same rows whatever the pieces in which the file is read. Input: protocol, then
// messages: kind (1 an exchange), milliseconds since the message before, length in two bytes,
// payload.
#include "kinalign/mcap/writer.h"
#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/wire/clockless.h"
#include "kinalign/wire/little_endian_reader.h"
#include "kinalign/wire/node_frame.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>

using namespace kinalign;

namespace {

constexpr std::array<std::string_view, 5> protocols{"kinalign-node", "kinect", "noitom", "xsens",
                                                    "slimevr"};

constexpr std::uint64_t utc_begin = 1'790'000'000'000'000'000;

void require(bool holds) {
  if (!holds) std::abort();
}

/// A skeleton of 59 joints in a chain, as text of a file of a lab.
std::string skeleton() {
  const std::string turns = "Yrotation Xrotation Zrotation\n";
  std::string text =
      "HIERARCHY\nROOT Hips\n{\nOFFSET 0 93 0\nCHANNELS 6 Xposition Yposition "
      "Zposition " +
      turns;
  for (int k = 1; k < 59; ++k) {
    text += "JOINT j" + std::to_string(k) + "\n{\nOFFSET 0 1 0\nCHANNELS 3 " + turns;
  }
  return text + "End Site\n{\nOFFSET 0 1 0\n}\n" + std::string(58, '}') +
         "}\nMOTION\nFrames: 0\nFrame Time: 0.008\n";
}

/// Reads numbers from the bytes; after their end it reads zeros.
struct Numbers {
  std::string_view bytes;
  template <class T>
  T take() {
    T value{};
    const std::size_t some = std::min(sizeof value, bytes.size());
    std::memcpy(&value, bytes.data(), some);
    bytes.remove_prefix(some);
    return value;
  }
};

/// The frame and the exchange of a node that the payload describes. They are built here because a
/// fuzzer can't guess a checksum.
struct SaidByNode {
  std::string exchange, frame;
};
SaidByNode clockless_node_says(Numbers from, HostTime arrival) {
  RecordedClockless recorded;
  recorded.epoch = from.take<std::uint8_t>() % 2U;
  ClocklessExchange& exchange = recorded.exchange;
  exchange.boot = from.take<std::uint8_t>() % 3U;
  ClocklessRequest request;
  request.origin = {7, 1, from.take<std::uint32_t>() >> (from.take<std::uint8_t>() % 32U)};
  exchange.frame = (std::uint64_t{1} << 32U) + request.origin.sequence;
  exchange.t2 = arrival;
  std::array<std::uint8_t, max_node_datagram> room{};
  if ((from.take<std::uint8_t>() & 1U) != 0) {
    exchange.t3 = arrival - Duration{from.take<std::uint32_t>()};
    exchange.t2 = exchange.t3 - Duration{from.take<std::uint32_t>()};
    exchange.t6 = arrival;
    const auto bytes = encode(ClocklessConfirm{request.origin, {}}, nullptr, room);
    return {to_bytes(recorded), std::string(text_of(bytes))};
  }
  request.has_sample = request.sample.has_acceleration = true;
  request.sample.age_us = from.take<std::uint32_t>();
  const auto bytes = encode(request, nullptr, room);
  return {to_bytes(recorded), std::string(text_of(bytes))};
}

SaidByNode node_says(std::string_view payload, HostTime arrival) {
  Numbers from{payload};
  if ((from.take<std::uint8_t>() & 3U) == 0) return clockless_node_says(from, arrival);
  NodeFrame frame;
  frame.origin = {7, 1, from.take<std::uint8_t>()};
  frame.n_tx_us = from.take<std::uint64_t>() >> (from.take<std::uint8_t>() % 64U);
  const bool echoes = (from.take<std::uint8_t>() & 1U) != 0;
  RecordedExchange recorded;
  recorded.epoch = from.take<std::uint8_t>() % 2U;
  Exchange& exchange = recorded.exchange;
  exchange.boot = from.take<std::uint8_t>() % 3U;
  exchange.n_tx = NodeTime{Duration{static_cast<std::int64_t>(1000 * frame.n_tx_us)}};
  exchange.h_rx = arrival;
  if (echoes) {
    const NodeTime now{std::chrono::microseconds(frame.n_tx_us % 1'000'000'000'000)};
    exchange.echo = {now - Duration{from.take<std::uint32_t>()},
                     arrival - Duration{from.take<std::uint32_t>()}};
  }
  frame.sample_count = 1 + from.take<std::uint8_t>() % 3U;
  for (std::size_t i = 0; i < frame.sample_count; ++i) {
    NodeSample& sample = frame.samples[i];
    const auto flags = from.take<std::uint8_t>();
    sample.has_acceleration = (flags & 1U) != 0;
    sample.has_orientation = (flags & 2U) != 0;
    sample.gravity_included = (flags & 5U) == 5U;
    sample.age_us = from.take<std::uint32_t>();
    for (float& part : sample.orientation) part = from.take<float>();
    for (float& part : sample.acceleration) part = from.take<float>();
  }
  std::array<std::uint8_t, max_node_datagram> room{};
  const auto bytes = encode(frame, nullptr, room);
  return {to_bytes(recorded), std::string(text_of(bytes))};
}

std::string recording_of(const std::uint8_t* data, std::size_t size) {
  const std::string protocol(protocols[data[0] % protocols.size()]);
  const std::string transport = (data[0] & 0x80U) != 0 ? "tcp" : "udp";
  const RawChannel raw{"s", protocol, transport, "10.0.0.1:5", protocol == protocols[0] ? "7" : "",
                       ""};
  McapChannel frames = to_channel("/s/raw", raw), exchanges = to_channel("/s/exchange", raw);
  exchanges.message_encoding = exchange_encoding;
  frames.id = 1;
  exchanges.id = 2;
  McapChunkContent content;
  content.add(frames);
  content.add(exchanges);
  std::uint64_t at = utc_begin;
  std::uint32_t number = 0;
  for (std::size_t i = 1; i + 4 <= size;) {
    const bool exchange = data[i] == 1;
    at += std::uint64_t{data[i + 1]} * 1'000'000;
    const std::size_t length =
        std::min<std::size_t>(data[i + 2] + 256U * data[i + 3], size - i - 4);
    const std::string_view payload(reinterpret_cast<const char*>(data) + i + 4, length);
    if (protocol == protocols[0]) {
      const HostTime arrival{Duration{static_cast<std::int64_t>(at - utc_begin)} +
                             std::chrono::seconds(5000)};
      const SaidByNode said = node_says(payload, arrival);
      content.add(McapMessage{2, number, at, at, said.exchange});
      content.add(McapMessage{1, number++, at, at, said.frame});
    } else {
      content.add(
          McapMessage{static_cast<std::uint16_t>(exchange ? 2 : 1), number++, at, at, payload});
    }
    i += 4 + length;
  }
  std::string file;
  McapWriter writer({[&](std::string_view more) {
                       file += more;
                       return Result<void>();
                     },
                     [&](std::uint64_t from, std::span<char> to) {
                       std::memcpy(to.data(), file.data() + from, to.size());
                       return Result<void>();
                     }});
  RecordingFacts facts;
  facts.first = "x";
  facts.anchor = {HostTime{std::chrono::seconds(5000)},
                  utc_time(static_cast<std::int64_t>(utc_begin))};
  require(writer.begin({std::string(recording_profile), ""}).has_value());
  require(writer.write(to_metadata(facts)).has_value());
  require(writer.write(McapAttachment{0, 0, "s.bvh", "", skeleton()}).has_value());
  require(writer.write(store(content, McapCompression::none)).has_value());
  require(writer.finish().has_value());
  return file;
}

void check_rows(const ClipFrames& f, const Skeleton& skeleton) {
  require(f.local_positions.size() == f.size() * skeleton.joints() * 3);
  require(f.local_rotations.size() == f.size() * skeleton.joints() * 4);
}
void check_rows(const PointFrames& f, const PointHeader& header) {
  require(f.positions.size() == f.size() * header.joint_names.size() * 3);
  require(f.state.size() == f.size() * header.joint_names.size());
  for (const double x : f.positions) require(std::isfinite(x));
}
void check_rows(const ImuSamples& s, const ImuHeader& header) {
  const std::size_t cells = s.size() * header.node_names.size();
  require(s.valid.size() == cells);
  require(s.orientation.size() == (header.content.orientation ? 4 * cells : 0));
  require(s.acceleration.size() == (header.content.acceleration ? 3 * cells : 0));
  for (std::size_t i = 0; header.content.orientation && i < cells; ++i) {
    double norm = 0.0;
    for (std::size_t k = 0; k < 4; ++k) norm += s.orientation[4 * i + k] * s.orientation[4 * i + k];
    require(s.valid[i] == 0 || std::abs(norm - 1.0) < 1e-6);
  }
}

template <class Frames>
std::vector<Time> read(DevicePass<Frames> pass, const TimeModel& clock) {
  std::vector<Time> stamps;
  Frames rows;
  for (;;) {
    const auto more = pass.next(rows);
    require(more.has_value());  // opening has read as far as a pass can fail
    if (!*more) return stamps;
    require(pass.header() != nullptr);
    check_rows(rows, *pass.header());
    constexpr std::int64_t furthest = 4'000'000'000'000'000'000;
    for (const Time stamp : rows.stamps) {
      require(std::abs(to_ns(stamp)) <= furthest);
      require(std::abs(to_ns(take_time(clock, stamp))) <= furthest);
    }
    stamps.insert(stamps.end(), rows.stamps.begin(), rows.stamps.end());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const std::string file = recording_of(data, size);
  const int fd = ::memfd_create("recording", MFD_CLOEXEC);
  require(::write(fd, file.data(), file.size()) == static_cast<ssize_t>(file.size()));
  PosixFiles files;
  StreamOptions options;
  options.name = "s";
  const std::string path = "/proc/self/fd/" + std::to_string(fd);
  const auto source =
      RecordingSource::open(files, path, RecordingSource::Devices::learned, {options});
  if (source) {
    const auto stream = (*source)->stream(options, {path, ""});
    // The stamps that the first pass finds are those of the rows, in every pass.
    for (int pass = 0; stream && pass < 2; ++pass) {
      const auto stamps = std::visit(
          [&](const auto& passes) { return read(passes(), stream->clock); }, stream->passes);
      require(stamps == *stream->stamps);
    }
  }
  ::close(fd);
  return 0;
}
