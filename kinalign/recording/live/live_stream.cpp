// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/live/live_stream.h"

#include "kinalign/protocols/protocols.h"
#include "kinalign/recording/frames/accepted_frames.h"
#include "kinalign/recording/frames/kinect_frames.h"
#include "kinalign/recording/streams/kinect_person.h"
#include "kinalign/wire/counter.h"

#include <algorithm>
#include <utility>

namespace kinalign {

namespace {

// If a stamp differs from its arrival by more than these limits, its clock is wrong.
constexpr Duration most_ahead = std::chrono::seconds(1);
constexpr Duration most_behind = std::chrono::seconds(10);

/// True if a stamp is plausible for its arrival.
bool is_credible(Time stamp, Time arrival) {
  return stamp <= arrival + most_ahead && stamp >= arrival - most_behind;
}

/// The error for bytes that are not a live stream. The user gave the address with --live, so the
/// error names this flag.
Failure no_stream(std::string found) {
  return Failure(Error{"--live", 0, "the stream of kinalign record --live-port", std::move(found)});
}

}  // namespace

struct LiveStream::Channel {
  RawChannel raw;
  bool is_marks = false;
  NodeDevice* node = nullptr;  // nullptr if the channel does not belong to a node
  KinectDevice* kinect = nullptr;
  std::optional<std::uint32_t> number;  // number of the newest message
};

/// One node. Its frames need their clock exchanges, which arrive on another channel of the same
/// node.
struct LiveStream::NodeDevice {
  RawChannel raw;
  AcceptedFrames frames;
  LiveClock clock;
};

/// One Kinect. It has two clocks, as in kinect_rows.cpp. Pings measure the sender's clock. The
/// sensor's clock is measured by the times at which the sender received frames.
struct LiveStream::KinectDevice {
  RawChannel raw;
  KinectFrames frames;
  std::vector<JoinedKinectFrame> joined;
  KinectPerson person{std::nullopt};
  LiveClock sender, sensor;
  std::uint32_t epoch = 0;            // number of suspensions of the host, see RecordedExchange
  HostTime newest = HostTime::min();  // time at which the sender received its newest frame
};

LiveStream::LiveStream() = default;
LiveStream::~LiveStream() = default;

Result<void> LiveStream::take(std::string_view bytes, LiveData& news) {
  reader_.feed(bytes);
  // A record is valid until the next one only, so its contents are copied into `news`.
  while (const auto record = reader_.next()) KA_TRY(take_record(*record, news));
  if (!reader_.is_mcap()) return no_stream("another beginning");
  // TCP delivers bytes undamaged, so any finding means that the bytes are not a live stream of
  // kinalign record.
  if (reader_.findings().empty()) return {};
  return no_stream(reader_.findings().front().what.found);
}

void LiveStream::end() {
  reader_.end();
  while (reader_.next()) {
  }
}

Result<void> LiveStream::take_record(const McapRecord& record, LiveData& news) {
  if (const auto* metadata = std::get_if<McapMetadata>(&record)) {
    if (!facts_) facts_ = to_facts(*metadata);
  } else if (const auto* channel = std::get_if<McapChannel>(&record)) {
    return define(*channel);
  } else if (const auto* message = std::get_if<McapMessage>(&record)) {
    return take_message(*message, news);
  }
  return {};
}

// Registers a channel. A channel without device data is only remembered.
Result<void> LiveStream::define(const McapChannel& channel) {
  // The stream may repeat definitions. The first definition of a channel is kept.
  if (channels_.contains(channel.id)) return {};
  if (channels_.size() == most_channels) {
    return no_stream("more than " + std::to_string(most_channels) + " channels");
  }
  Channel& added = channels_[channel.id];
  added.is_marks = channel.topic == marks_topic;
  const auto raw = to_raw(channel);
  if (!raw) return {};
  added.raw = *raw;
  const auto protocol = protocol_of(*raw);
  if (!raw->node.empty() && protocol == Protocol::nodes) {
    auto& device = nodes_[raw->stream + "/" + raw->node];
    if (!device) device = std::make_unique<NodeDevice>(NodeDevice{*raw, {}, LiveClock()});
    added.node = device.get();
  } else if (protocol == Protocol::kinect) {
    auto& device = kinects_[raw->stream];
    if (!device) {
      device = std::make_unique<KinectDevice>();
      device->raw = *raw;
    }
    added.kinect = device.get();
  }
  return {};
}

// Before the times of a message are used, checks refuse a stream that is not kinalign's.
Result<void> LiveStream::take_message(const McapMessage& message, LiveData& news) {
  // The anchor is needed to convert log times.
  if (!facts_) return no_stream("messages before the recording's metadata");
  if (message.log_time > static_cast<std::uint64_t>(latest_log_time))
    return no_stream("a time after 2096");
  const Time arrival = utc_time(static_cast<std::int64_t>(message.log_time));
  if (now_ && arrival > *now_ + longest_silence) return no_stream("a minute without any message");
  // The recorder merges channels, so an arrival may be slightly earlier than the newest arrival.
  now_ = now_ ? std::max(*now_, arrival) : arrival;
  const auto found = channels_.find(message.channel);
  if (found == channels_.end()) return {};
  Channel& channel = found->second;
  ++counts_.messages;
  // If this is the first message of a channel, or if the numbers went back, no message counts as
  // lost.
  const auto steps = steps_between(channel.number.value_or(message.sequence), message.sequence, 32);
  if (steps > 1) counts_.lost += static_cast<std::uint64_t>(steps - 1);
  channel.number = message.sequence;
  if (channel.is_marks) {
    if (const auto mark = to_mark(message.data)) news.marks.push_back({*mark, arrival});
    return {};
  }
  const RecordedMessage recorded{&channel.raw, message.channel,
                                 arrival_of(message.log_time, facts_->utc_minus_host()),
                                 message.data};
  if (channel.node != nullptr) take_node(*channel.node, recorded, news);
  if (channel.kinect != nullptr) take_kinect(*channel.kinect, recorded, news);
  return {};
}

// Takes a message of a node. If the node's clock is not known yet, a sample is stamped by arrival
// and age.
void LiveStream::take_node(NodeDevice& device, const RecordedMessage& message, LiveData& news) {
  if (message.is_exchange()) {
    const AnyExchange any = device.frames.take_exchange(message);
    if (const auto* exchange = std::get_if<Exchange>(&any)) device.clock.push(*exchange);
    return;
  }
  const auto frame = device.frames.take(message);
  if (!frame) return;
  const Time arrival = on_axis(message.arrival);
  for (std::size_t i = 0; i < frame->sample_count; ++i) {
    const NodeSample& sample = frame->samples[i];
    const auto age = std::chrono::microseconds(sample.age_us);
    const auto at =
        frame->n_tx ? device.clock.host_from_node(frame->boot, *frame->n_tx - age) : std::nullopt;
    const Time stamp = at ? on_axis(at->time) : arrival - age;
    // Samples with impossible values are counted here, because later steps do not see the raw
    // values.
    const SampleFaults wrong = faults(sample);
    if (!is_credible(stamp, arrival) || wrong.not_finite || wrong.zero_orientation) {
      ++counts_.refused;
      continue;
    }
    news.samples.push_back({&device.raw, stamp, arrival, sample});
  }
}

// Takes a message of a Kinect. An exchange updates the sender's clock. Other messages may complete
// frames.
void LiveStream::take_kinect(KinectDevice& device, const RecordedMessage& message, LiveData& news) {
  if (message.is_exchange()) {
    if (auto recorded = to_exchange(message.payload)) {
      // Frames do not contain the number of the host's suspensions, so they use the number in the
      // newest exchange.
      device.epoch = recorded->epoch;
      recorded->exchange.boot = boot_in_epoch(recorded->exchange.boot, recorded->epoch);
      device.sender.push(recorded->exchange);
    }
    return;
  }
  device.joined.clear();
  device.frames.take(message, device.joined, nullptr);
  for (const JoinedKinectFrame& one : device.joined) take_frame(device, one.frame, message, news);
}

// Stamps a frame. If the sender's clock is not known yet, the stamp is the arrival minus the time
// between the sender's receiving and sending of the frame.
void LiveStream::take_frame(KinectDevice& device, const KinectFrame& frame,
                            const RecordedMessage& message, LiveData& news) {
  const BootKey boot = boot_in_epoch(frame.origin.session, device.epoch);
  const auto sender_had = [&] {
    const auto at = device.sender.host_from_node(boot, kinect_sender_time(frame.taken_ticks));
    if (at) return at->time;
    return message.arrival -
           (kinect_sender_time(frame.sent_ticks) - kinect_sender_time(frame.taken_ticks));
  }();
  device.newest = std::max(device.newest, sender_had);  // the clock needs rising arrivals
  const NodeTime ticks = kinect_sender_time(frame.device_ticks);
  device.sensor.push_up(boot, ticks, device.newest);
  const auto at = device.sensor.host_from_node(boot, ticks);
  const Time arrival = on_axis(message.arrival);
  LiveKinectRow row{&device.raw, arrival, {}};
  // If the person is not in the frame, id 0 gives a row without joints.
  append_kinect_row(frame, device.person(frame).value_or(0), row.row);
  row.row.stamps.back() = on_axis(at ? at->time : sender_had);
  if (is_credible(row.row.stamps.back(), arrival)) {
    news.rows.push_back(std::move(row));
  } else {
    ++counts_.refused;
  }
}

}  // namespace kinalign
