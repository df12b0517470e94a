// SPDX-License-Identifier: Apache-2.0
// A recording of three devices in memory, for tests. Each sample carries the true time at which it
// was taken, in seconds since the recording began, so a reader's stamps can be checked against it.
#pragma once

#include "tests/mcap/mcap_files.h"
#include "tests/protocols/kinect/kinect_lines.h"
#include "tests/protocols/noitom/noitom_writer.h"
#include "tests/protocols/xsens/xsens_cases.h"

#include "kinalign/protocols/kinect/binary.h"
#include "kinalign/protocols/kinect/frames.h"
#include "kinalign/protocols/noitom/stream.h"
#include "kinalign/recording/format.h"
#include "kinalign/wire/clockless.h"
#include "kinalign/wire/little_endian_reader.h"
#include "kinalign/wire/node_frame.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace kinalign {

/// 59 joints in a chain, with 180 or 354 channels, in Noitom's order of rotations.
inline std::string noitom_chain(const std::string& tenth, bool displacement) {
  const std::string rotations = "Yrotation Xrotation Zrotation\n";
  const std::string six = "CHANNELS 6 Xposition Yposition Zposition " + rotations;
  std::string text = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 93 0\n" + six;
  for (int k = 1; k < 59; ++k) {
    text += "JOINT " + (k == 10 ? tenth : "j" + std::to_string(k)) + "\n{\nOFFSET 0 1 0\n" +
            (displacement ? six : "CHANNELS 3 " + rotations);
  }
  text += "End Site\n{\nOFFSET 0 1 0\n}\n" + std::string(58, '}') + "}\n";
  return text + "MOTION\nFrames: 0\nFrame Time: 0.008\n";
}

class RecordedLab {
 public:
  static constexpr std::int64_t utc_begin = 1'790'000'000'000'000'000;
  /// The machine has been up for 5000 s.
  static constexpr std::int64_t host_begin = 5'000'000'000'000;

  explicit RecordedLab(std::uint64_t seed) : random_(seed) {}

  std::uint64_t dropped = 0;  // messages for which memory had no room

  /// A counter that reads `at_begin_s` when the recording begins and is fast by `ppm`. While the
  /// host sleeps the counter moves on by `slept_s`, and the host's clock does not. Less than 0: the
  /// host's clock went back.
  struct Counter {
    double at_begin_s = 0.0, ppm = 0.0;
    double sleep_at_s = 1e9, slept_s = 0.0;
    double at(double t) const {
      return at_begin_s + t * (1.0 + 1e-6 * ppm) + (t >= sleep_at_s ? slept_s : 0.0);
    }
  };

  /// `frames_hz` frames a second from `from` to `to`, with two samples each; all are answered.
  void add_node(std::uint32_t id, std::uint32_t boot_id, Counter counter, double from, double to,
                const std::string& place = "", double frames_hz = 15.0) {
    const auto us = [&](double t) { return static_cast<std::uint64_t>(1e6 * counter.at(t)); };
    const RawChannel raw{"imu", "kinalign-node", "udp", "10.0.0.7:5005", std::to_string(id), place};
    const std::string topic = "/imu/" + std::to_string(id);
    const auto frames = channel(to_channel(topic + "/raw", raw));
    McapChannel described = to_channel(topic + "/exchange", raw);
    described.message_encoding = exchange_encoding;
    const auto exchanges = channel(described);
    std::optional<Exchange::Echo> echo;
    std::uint32_t sequence = 0;
    const auto step_us = static_cast<std::uint32_t>(0.5e6 / frames_hz);  // between samples
    for (double t = from; t < to; t += 1.0 / frames_hz) {
      NodeFrame frame;
      frame.origin = {id, boot_id, sequence++};
      frame.n_tx_us = us(t);
      frame.sample_count = 2;
      for (std::size_t i = 0; i < 2; ++i) {
        NodeSample& sample = frame.samples[i];
        sample.age_us = i == 0 ? 7'000 + step_us : 7'000;
        sample.has_acceleration = sample.has_angular_velocity = sample.gravity_included = true;
        sample.acceleration = {static_cast<float>(t - 1e-6 * sample.age_us), 9.8F, 0.0F};
      }
      std::array<std::uint8_t, max_node_datagram> room{};
      const auto bytes = encode(frame, nullptr, room);
      const double arrival = t + way();
      const NodeTime n{std::chrono::microseconds(frame.n_tx_us)};
      add(exchanges, {0, {boot_id, n, host(arrival), echo}}, arrival);
      add(frames, arrival, std::string(text_of(bytes)));
      const double sent = arrival + 0.0003;
      echo = {NodeTime{std::chrono::microseconds(us(sent + way()))}, host(sent)};
    }
  }

  /// Fifteen requests a second with one sample each, answered and confirmed; each `lost`th is lost.
  void add_clockless_node(std::uint32_t id, double to, std::uint32_t lost) {
    const RawChannel raw{"imu", "kinalign-node", "udp", "10.0.0.8:5005", std::to_string(id), ""};
    const std::string topic = "/imu/" + std::to_string(id);
    const auto datagrams = channel(to_channel(topic + "/raw", raw));
    McapChannel described = to_channel(topic + "/exchange", raw);
    described.message_encoding = exchange_encoding;
    const auto exchanges = channel(described);
    for (std::uint32_t k = 0; k < 15.0 * to; ++k) {
      if (k % lost == lost - 1) continue;
      const double t = k / 15.0, arrival = t + way(), answered = arrival + 0.0003;
      const double confirmed = answered + way() + way();
      std::array<std::uint8_t, max_node_datagram> room{};
      ClocklessRequest request;
      request.origin = {id, 1, k};
      request.has_sample = true;
      request.sample.has_acceleration = true;
      request.sample.acceleration = {static_cast<float>(t), 9.8F, 0.0F};
      const std::uint64_t number = (std::uint64_t{1} << 32U) + k;
      add(exchanges, arrival, to_bytes(RecordedClockless{0, {number, host(arrival), {}, {}, 1}}));
      add(datagrams, arrival, std::string(text_of(encode(request, nullptr, room))));
      const ClocklessConfirm confirm{request.origin, {}};
      const ClocklessExchange exchange{number, host(arrival), host(answered), host(confirmed), 1};
      add(exchanges, confirmed, to_bytes(RecordedClockless{0, exchange}));
      add(datagrams, confirmed, std::string(text_of(encode(confirm, nullptr, room))));
    }
  }

  /// The form of a Kinect's messages: binary, or lines without an end, as datagrams may have them.
  enum class KinectForm { binary, bare_lines };
  /// Thirty frames a second of one body. They take `least_s` and more from the sensor to the
  /// sender, which has a clock of its own; four pings a second.
  void add_kinect(Counter sensor, Counter sender, double least_s, double to,
                  KinectForm form = KinectForm::binary) {
    const auto ticks = [](const Counter& c, double t) {
      return static_cast<std::int64_t>(1e7 * c.at(t));
    };
    const RawChannel raw{"kinect", "kinect", "udp", "10.0.0.9:6007", "", ""};
    const auto frames = channel(to_channel("/kinect/raw", raw));
    McapChannel described = to_channel("/kinect/exchange", raw);
    described.message_encoding = exchange_encoding;
    const auto exchanges = channel(described);
    sleep_at_s_ = std::min(sleep_at_s_, sender.sleep_at_s);
    for (std::uint32_t k = 0; k < 30.0 * to; ++k) {
      const double t = k / 30.0, taken = t + least_s + way() / 4.0, sent = taken + 0.0001;
      KinectFrame frame;
      frame.origin = {2, 77, k};
      frame.device_ticks = ticks(sensor, t);
      frame.taken_ticks = ticks(sender, taken);
      frame.sent_ticks = ticks(sender, sent);
      KinectBody body;
      body.id = 72057594037927936;
      body.states.fill(2);
      for (std::size_t q = 1; q < body.positions.size(); ++q) {
        const auto place = static_cast<double>(q);
        body.positions[q] = static_cast<float>(0.3 * std::sin(place) + 0.1 * std::sin(t + place));
      }
      body.positions[0] = static_cast<float>(t);
      frame.bodies = {body};
      const auto bytes = encode_kinect_binary(frame);
      std::string text(bytes.begin(), bytes.end());
      if (form == KinectForm::bare_lines) {
        text = encode_kinect_line(frame);
        while (text.ends_with('\n')) text.pop_back();
      }
      add(frames, sent + way(), std::move(text));
    }
    std::optional<Exchange::Echo> echo;
    for (double t = 0.01; t < to; t += 0.25) {
      const double arrival = t + way(), answered = arrival + 0.0002;
      const NodeTime n = kinect_sender_time(ticks(sender, t));
      if (t >= sender.sleep_at_s && t - 0.25 < sender.sleep_at_s) echo.reset();
      add(exchanges, {0, {77, n, host(arrival), echo}}, arrival);
      echo = {kinect_sender_time(ticks(sender, answered + way())), host(answered)};
    }
  }

  /// Any bytes that somebody sends to a device's port.
  void add_datagram(const RawChannel& raw, double at, std::string bytes) {
    add(channel(to_channel("/" + raw.stream + "/raw/" + raw.sender, raw)), at, std::move(bytes));
  }

  /// 125 frames a second whose root's x is the time, in metres; each `lost`th is lost.
  void add_mocap(NoitomForm form, const std::string& transport, double to, std::uint32_t lost = 0,
                 const std::string& sender = "10.0.0.3:7012", bool displacement = false) {
    skeleton_ = noitom_chain("Spine3", displacement);
    const auto frames =
        channel(to_channel("/mocap/raw/" + sender, {"mocap", "noitom", transport, sender, "", ""}));
    double last = 0.0;
    for (std::uint32_t k = 0; k < 125.0 * to; ++k) {
      if (lost > 0 && k % lost == lost - 1) continue;
      const double t = k * 0.008;
      NoitomFrame frame;
      frame.form = form;
      frame.name = "Char01";
      /// The number wraps.
      if (form == NoitomForm::new_header) frame.frame_index = 4'294'967'000U + k;
      frame.displacement = displacement;
      frame.values.resize(noitom_values(displacement, false));
      for (std::size_t q = 1; q < frame.values.size(); ++q) {
        frame.values[q] = static_cast<float>(10.0 * std::sin(t + static_cast<double>(q)));
      }
      frame.values[0] = static_cast<float>(100.0 * t);
      std::vector<std::uint8_t> bytes;
      append_form_of_noitom(frame, bytes);
      last = std::max(last, t + way() / 4.0);  // no frame overtakes another
      add(frames, last, {bytes.begin(), bytes.end()});
    }
  }

  /// Removes the mocap's skeleton, as if the lab had named none.
  void forget_skeleton() { skeleton_.clear(); }

  /// A SlimeVR tracker's packets of type 23, a hundred a second. The acceleration's x, in steps of
  /// 1/128 m/s2, is as near to the time as that allows. `forged`: the number of a packet in the
  /// middle that is not the tracker's.
  void add_tracker(const std::string& host, double to, std::uint64_t forged = 0,
                   std::uint8_t sensors = 1) {
    const auto channel_id = channel(
        to_channel("/slime/raw/" + host, {"slime", "slimevr", "udp", host + ":6969", "", ""}));
    if (forged > 0) add(channel_id, to / 2.0, tracker_packet(forged, to / 2.0));
    double last = 0.0;
    for (std::uint32_t k = 0; k < 100.0 * to; ++k) {
      const double t = 0.01 * k;
      last = std::max(last, t + way());  // no packet overtakes another
      for (std::uint8_t sensor = 0; sensor < sensors; ++sensor) {
        const std::uint64_t number = std::uint64_t{k} * sensors + sensor + 1;
        add(channel_id, last, tracker_packet(number, t, sensor));
      }
    }
  }

  /// Both clocks of the machine once a second; the wall clock is set by `step_s` at `at`.
  void add_clock(double to, double at, double step_s) {
    McapChannel described;
    described.topic = host_clock_topic;
    described.message_encoding = "json";
    const auto pairs = channel(described);
    for (double t = 0.0; t < to; t += 1.0) {
      const Duration moved{std::llround(1e9 * (t >= at ? step_s : 0.0))};
      add(pairs, t, to_json(ClockPair{host(t), utc(t) + moved}));
    }
  }

  void add_mark(double t, const Mark& mark) {
    McapChannel described;
    described.topic = marks_topic;
    described.message_encoding = "json";
    if (!marks_) marks_ = channel(described);
    add(*marks_, t, to_json(RecordedMark{mark, "call", "10.0.0.9:40000"}));
  }

  static std::string tracker_packet(std::uint64_t number, double t, std::uint8_t sensor = 0) {
    std::string bytes;
    const auto put = [&bytes](std::uint64_t value, int size) {
      for (int i = size - 1; i >= 0; --i) bytes += static_cast<char>(value >> 8 * i);
    };
    put(23, 4);
    put(number, 8);
    put(sensor, 1);
    for (const int part : {0, 0, 0, 32767}) put(static_cast<std::uint64_t>(part), 2);
    for (const auto a : {std::llround(128.0 * t), 0LL, 0LL}) put(static_cast<std::uint64_t>(a), 2);
    return bytes;
  }

  /// One of a recording's files: its messages from `from` to `to`.
  struct Part {
    int number = 1;
    double from = -1e9, to = 1e9;
    std::string first = "take.mcap";
    McapCompression compression = McapCompression::zstd;
    double chunk_s = 0.5;
  };
  std::string file(bool closed = true) { return file(Part{}, closed); }
  /// The file, its messages in the order of arrival.
  std::string file(const Part& part, bool closed = true) {
    std::stable_sort(messages_.begin(), messages_.end(),
                     [](const Message& a, const Message& b) { return a.arrival < b.arrival; });
    MemoryFile file;
    McapWriter writer(file.store());
    REQUIRE(writer.begin({"kinalign", "test"}));
    REQUIRE(writer.write(to_metadata(
        {"03", "S1A02", "lab", part.first, part.number, {host(0.0), utc_time(utc_begin)}})));
    if (!skeleton_.empty()) REQUIRE(writer.write(McapAttachment{0, 0, "mocap.bvh", "", skeleton_}));
    std::map<std::uint16_t, std::uint32_t> numbers;
    for (auto message = messages_.begin(); message != messages_.end();) {
      const double begin = message->arrival;
      McapChunkContent content;
      for (; message != messages_.end() && message->arrival < begin + part.chunk_s; ++message) {
        const std::uint16_t id = message->channel;
        const std::uint32_t number = numbers[id]++;
        if (message->arrival < part.from || message->arrival >= part.to) continue;
        if (!content.messages().contains(id)) define(channels_[id - 1U], content);
        const auto log =
            static_cast<std::uint64_t>(utc_begin + std::llround(1e9 * message->arrival));
        content.add(McapMessage{id, number, log, log, data_of(*message)});
      }
      if (!content.empty()) REQUIRE(writer.write(store(content, part.compression)));
    }
    const bool is_last = messages_.empty() || part.to > messages_.back().arrival;
    if (closed && is_last) REQUIRE(writer.write(to_metadata(RecordingEnd{dropped})));
    if (closed) REQUIRE(writer.finish());
    return file.bytes;
  }

  /// Sixty samples a second of Xsens MVN: poses and trackers in turn. The first acceleration's x of
  /// the trackers is the time.
  void add_xsens(double to) {
    const auto datagrams =
        channel(to_channel("/xsens/raw", {"xsens", "xsens", "udp", "10.0.0.4:9763", "", ""}));
    double last = 0.0;
    for (std::uint32_t k = 0; k < 60.0 * to; ++k) {
      const double t = k / 60.0;
      XsensSample trackers = xsens_trackers(true, k);
      std::get<XsensTrackers>(trackers.body).trackers[0].raw->acceleration[0] =
          static_cast<float>(t);
      last = std::max(last, t + way() / 4.0);
      for (const XsensSample& sample : {xsens_pose(23, k), trackers}) {
        const Bytes bytes = bytes_of(sample);
        add(datagrams, last, {bytes.begin(), bytes.end()});
      }
    }
  }

  /// Delays each `each`th message, and the `before` messages before it, by `by_s`, so that later
  /// ones overtake them.
  void hold_back(std::size_t each, double by_s, std::size_t before = 0) {
    for (std::size_t i = 0; i < messages_.size(); ++i) {
      if (i % each + before >= each - 1) messages_[i].arrival += by_s;
    }
  }

  /// Exchanges that arrive from `from` to `to` state another epoch of the host than theirs.
  void mistake_epoch(double from, double to) { mistaken_ = {from, to}; }

  /// Joins each two messages into one, which arrives with the later one.
  void join_pairs() {
    std::vector<Message> joined;
    for (std::size_t i = 1; i < messages_.size(); i += 2) {
      joined.push_back(messages_[i]);
      joined.back().data = messages_[i - 1].data + messages_[i].data;
    }
    messages_ = std::move(joined);
  }

  /// Cuts each message into two, which arrive together.
  void cut_in_two() {
    std::vector<Message> cut;
    for (const Message& one : messages_) {
      const std::size_t half = one.data.size() / 2;
      cut.push_back({one.channel, one.arrival, one.data.substr(0, half), std::nullopt});
      cut.push_back({one.channel, one.arrival, one.data.substr(half), std::nullopt});
    }
    messages_ = std::move(cut);
  }

  static HostTime host(double t) { return HostTime{Duration{host_begin + std::llround(1e9 * t)}}; }
  /// The time of a moment of the recording, s since its beginning.
  static Time utc(double t) { return utc_time(utc_begin + std::llround(1e9 * t)); }

 private:
  struct Message {
    std::uint16_t channel = 0;
    double arrival = 0.0;
    std::string data;
    std::optional<RecordedExchange> exchange;  // its arrival and epoch are those of the message
  };
  std::uint16_t channel(McapChannel described) {
    described.id = static_cast<std::uint16_t>(channels_.size() + 1);
    if (described.message_encoding == "json") described.schema_id = described.id;
    channels_.push_back(std::move(described));
    return channels_.back().id;
  }
  static void define(const McapChannel& channel, McapChunkContent& content) {
    if (channel.schema_id != 0) content.add(McapSchema{channel.schema_id, "any", "jsonschema", ""});
    content.add(channel);
  }
  void add(std::uint16_t channel, double arrival, std::string data) {
    messages_.push_back({channel, arrival, std::move(data), std::nullopt});
  }
  void add(std::uint16_t channel, const RecordedExchange& exchange, double arrival) {
    messages_.push_back({channel, arrival, "", exchange});
  }
  /// The bytes that the recorder writes for the message.
  std::string data_of(const Message& message) const {
    if (!message.exchange) return message.data;
    RecordedExchange recorded = *message.exchange;
    const bool is_behind = message.arrival >= sleep_at_s_;
    const bool is_mistaken =
        message.arrival >= mistaken_.first && message.arrival < mistaken_.second;
    recorded.epoch = is_behind != is_mistaken ? 1 : 0;
    recorded.exchange.h_rx = host(message.arrival);
    return to_bytes(recorded);
  }
  /// The delay of a packet, s: at least 1.5 ms, seldom much more.
  double way() { return 0.0015 + std::exponential_distribution<double>(250.0)(random_); }

  std::mt19937_64 random_;
  std::vector<McapChannel> channels_;
  std::vector<Message> messages_;
  std::optional<std::uint16_t> marks_;  // channel of the marks
  std::string skeleton_;
  double sleep_at_s_ = 1e9;  // host time at which the machine sleeps, s
  std::pair<double, double> mistaken_{1e9, 1e9};
};

}  // namespace kinalign
