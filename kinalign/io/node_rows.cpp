// SPDX-License-Identifier: Apache-2.0
// Frames of an inertial node of ours: the counter's reading of each sample, put on UTC by the
// exchanges that the recorder made out of frames and replies.
#include "kinalign/io/device_rows.h"
#include "kinalign/io/imu_converter.h"
#include "kinalign/io/little_endian_reader.h"
#include "kinalign/wire/node_frame.h"

#include <fmt/format.h>

#include <map>
#include <utility>

namespace kinalign {

namespace {

constexpr std::uint64_t most_counter_us = 1'000'000'000'000'000;  // 31 years

/// What was accepted when it came; absent: no frame, or damaged.
std::optional<NodeFrame> frame_in(const RecordedMessage& message) {
  Envelope envelope;
  if (open_envelope(octets(message.payload), envelope) != NodeRefusal::none) return std::nullopt;
  envelope.mac_was_checked = true;
  NodeFrame frame;
  if (decode(envelope, nullptr, frame) != NodeRefusal::none) return std::nullopt;
  if (frame.n_tx_us > most_counter_us) return std::nullopt;
  return frame;
}

NodeTime counter_at(std::uint64_t us) {
  return NodeTime{std::chrono::microseconds(static_cast<std::int64_t>(us))};
}

/// The host's axis begins anew where it slept: another life for the clock.
BootKey life_of(const RecordedExchange& recorded) {
  return recorded.exchange.boot ^ (BootKey{recorded.epoch} << 40U);
}

/// An accepted frame, and the life of its counter.
struct AcceptedFrame {
  NodeFrame frame;
  BootKey life = 0;
};

/// What was held, came twice or came late is in the recording, too; of an accepted frame the
/// exchange stands before it, with the same counter and arrival.
class AcceptedFrames {
 public:
  void take(const RecordedExchange& recorded, HostTime arrival) {
    exchange_ = {life_of(recorded), recorded.exchange.n_tx, arrival};
  }
  std::optional<AcceptedFrame> take(const RecordedMessage& message) {
    const auto accepted = std::exchange(exchange_, std::nullopt);
    auto frame = frame_in(message);
    const bool is_accepted = frame && accepted && accepted->at == message.arrival &&
                             accepted->n == counter_at(frame->n_tx_us);
    if (!is_accepted) {
      ++others;
      return std::nullopt;
    }
    return AcceptedFrame{*frame, accepted->life};
  }

  std::uint64_t others = 0;

 private:
  struct Accepted {
    BootKey life = 0;
    NodeTime n;
    HostTime at;
  };
  std::optional<Accepted> exchange_;
};

class NodeListener final : public DeviceListener {
 public:
  explicit NodeListener(const DeviceWish& wish) : file_(wish.file.path) {}

  void take(const RecordedMessage& message) override {
    if (message.is_exchange()) {
      if (const auto recorded = to_exchange(message.payload)) {
        frames_.take(*recorded, message.arrival);
        exchanges_.push_back(recorded->exchange);
        exchanges_.back().boot = life_of(*recorded);
      }
      return;
    }
    const auto accepted = frames_.take(message);
    if (!accepted) return;
    const NodeFrame& frame = accepted->frame;
    for (std::size_t i = 0; i < frame.sample_count; ++i) {
      const NodeSample& sample = frame.samples[i];
      content_.orientation |= sample.has_orientation;
      content_.acceleration |= sample.has_acceleration;
      content_.angular_velocity |= sample.has_angular_velocity;
      if (sample.has_acceleration) content_.gravity &= sample.gravity_included;
    }
  }

  Result<void> finish(HeardDevice& heard) override {
    if (exchanges_.empty()) {
      return Failure(Error{file_, 0, "exchanges with node " + heard.channel.node,
                           "none: of a node without a counter no time is known but arrivals"});
    }
    heard.clock = device_clock(exchanges_, heard.utc_minus_host);
    heard.content = content_;
    return {};
  }

 private:
  std::string file_;
  std::vector<Exchange> exchanges_;
  AcceptedFrames frames_;
  ImuContent content_;
};

class NodeRows final : public DeviceRows<ImuSamples> {
 public:
  NodeRows(const DeviceWish& wish, std::shared_ptr<const HeardDevice> heard)
      : heard_(std::move(heard)),
        file_(wish.file.path),
        converter_(ImuUnits{axes_of(y_up, wish.options), 1.0, 1.0}) {
    const RawChannel& channel = heard_->channel;
    const std::string& own = channel.place.empty() ? channel.node : channel.place;
    header_.node_names = {wish.file.node.empty() ? own : wish.file.node};
    header_.content = heard_->content;
  }

  Result<void> take(const RecordedMessage& message, ImuSamples& out) override {
    if (message.is_exchange()) {
      if (const auto recorded = to_exchange(message.payload)) {
        frames_.take(*recorded, message.arrival);
      }
      return {};
    }
    const auto accepted = frames_.take(message);
    if (!accepted) return {};
    const NodeFrame& frame = accepted->frame;
    for (std::size_t i = 0; i < frame.sample_count; ++i) {
      const NodeSample& sample = frame.samples[i];
      const NodeTime n = counter_at(frame.n_tx_us) - std::chrono::microseconds(sample.age_us);
      const auto stamp = stamp_of(heard_->clock, accepted->life, n, message.arrival);
      if (!stamp) {
        ++unknown_;
        continue;
      }
      waiting_.emplace(*stamp, sample);
    }
    while (waiting_.size() > most_waiting) release(out);
    return {};
  }

  Result<void> finish(ImuSamples& out) override {
    while (!waiting_.empty()) release(out);
    converter_.report(file_, findings);
    tell(frames_.others, "datagrams that were accepted", "others: held, late, twice or damaged",
         "they were passed over");
    tell(unknown_, "samples of a life of the node whose clock is known", "samples of others",
         "they were left out");
    tell(partial_, "samples with all that the node sends at times",
         "samples without, or with numbers that are none", "these samples are invalid");
    return {};
  }

  const ImuHeader* header() const override { return &header_; }

 private:
  void tell(std::uint64_t count, std::string expected, std::string_view found,
            std::string_view meaning) {
    if (count == 0) return;
    findings.push_back({Severity::note,
                        Error{file_, 0, std::move(expected), fmt::format("{} {}", count, found)},
                        std::string(meaning), ""});
  }

  void release(ImuSamples& out) {
    out.stamps.push_back(waiting_.begin()->first);
    append(waiting_.begin()->second, out);
    waiting_.erase(waiting_.begin());
  }

  void append(const NodeSample& sample, ImuSamples& out) {
    const std::array<double, 4> q{sample.orientation[0], sample.orientation[1],
                                  sample.orientation[2], sample.orientation[3]};
    const std::array<double, 3> a{sample.acceleration[0], sample.acceleration[1],
                                  sample.acceleration[2]};
    const std::array<double, 3> w{sample.angular_velocity[0], sample.angular_velocity[1],
                                  sample.angular_velocity[2]};
    const ImuContent& content = header_.content;
    RawImuSample raw;
    if (content.orientation) raw.orientation = q.data();
    if (content.acceleration) raw.acceleration = a.data();
    if (content.angular_velocity) raw.angular_velocity = w.data();
    const bool mixed = sample.has_acceleration && sample.gravity_included != content.gravity;
    raw.valid = sample.has_orientation >= content.orientation &&
                sample.has_acceleration >= content.acceleration &&
                sample.has_angular_velocity >= content.angular_velocity && !mixed &&
                !faults(sample).not_finite;
    partial_ += raw.valid ? 0U : 1U;
    converter_.append(raw, out);
  }

  std::shared_ptr<const HeardDevice> heard_;
  std::string file_;
  ImuConverter converter_;
  ImuHeader header_;
  AcceptedFrames frames_;
  // A radio lets frames overtake each other: samples wait for those that were taken before them.
  static constexpr std::size_t most_waiting = 64;
  std::multimap<Time, NodeSample> waiting_;
  std::uint64_t unknown_ = 0, partial_ = 0;
};

}  // namespace

DeviceProtocol node_protocol() { return device_protocol<NodeListener, NodeRows>("kinalign-node"); }

}  // namespace kinalign
