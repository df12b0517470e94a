// SPDX-License-Identifier: Apache-2.0
// Makes the rows of kinalign's inertial nodes. The exchanges that the recorder stored convert the
// counter at each sample to UTC. If a node has no counter, the numbers of its requests serve as the
// counter.
#include "kinalign/formats/imu_converter.h"
#include "kinalign/recording/frames/accepted_frames.h"
#include "kinalign/recording/streams/device_rows.h"
#include "kinalign/recording/streams/numbered_frames.h"
#include "kinalign/recording/streams/rows_in_order.h"

#include <fmt/format.h>

#include <deque>
#include <functional>
#include <utility>
#include <variant>
#include <vector>

namespace kinalign {

namespace {

/// Learns the clock of a node without a counter. Its requests are sent by a steady timer, so their
/// numbers serve as a counter. The earliest arrivals minus the shortest one-way delay determine the
/// clock (clock/offline/clockless.h).
void clockless_clock(const std::vector<ClocklessExchange>& exchanges, const DeviceRequest& request,
                     LearnedDevice& learned) {
  const auto least = least_one_way_delay(exchanges);
  std::vector<CountedFrame> requests;
  for (const ClocklessExchange& e : exchanges) {
    if (e.t6) continue;
    requests.push_back({e.boot, number_of(e), e.t2 - least.value_or(Duration{0})});
  }
  count_clock(std::move(requests), 0.0, request, learned);
  if (least) return;
  learned.findings.push_back(
      {Severity::warning,
       Error{request.file.path, 0, "confirmations from this node, which has no counter", "none"},
       "its stamps are late by the delay of its fastest request", ""});
}

/// The stamp of a sample; empty if its clock is not known.
std::optional<Time> stamp_of_sample(const LearnedDevice& learned, const AcceptedFrame& frame,
                                    std::uint32_t age_us, HostTime arrival) {
  // True if the node has no counter and its requests are counted.
  const bool counted = learned.step_ns > 0.0;
  if (counted == frame.n_tx.has_value()) return std::nullopt;
  const NodeTime sent =
      counted ? counter_of({frame.boot, frame.number, {}}, learned.step_ns) : *frame.n_tx;
  return stamp_of(learned.clock, frame.boot, sent - std::chrono::microseconds(age_us), arrival);
}

constexpr std::size_t most_overtaking_samples =
    64;  // the samples of a few frames, which a radio may reorder

/// Learns the clock of one node and keeps the data for its samples' stamps. These are a few bytes
/// per frame and the age of each sample.
class NodeListener final : public DeviceListener {
 public:
  explicit NodeListener(std::optional<std::uint64_t>) {}

  /// Keeps the exchanges. For each frame, keeps the index of its exchange and the ages of its
  /// samples.
  void take(const RecordedMessage& message) override {
    if (message.is_exchange()) {
      const AnyExchange any = frames_.take_exchange(message);
      if (const auto* e = std::get_if<Exchange>(&any)) exchanges_.push_back(*e);
      if (const auto* e = std::get_if<ClocklessExchange>(&any)) clockless_.push_back(*e);
      return;
    }
    const auto frame = frames_.take(message);
    if (!frame) return;
    const bool has_counter = frame->n_tx.has_value();
    const std::size_t exchanges = has_counter ? exchanges_.size() : clockless_.size();
    // The frame's exchange is the last stored exchange, because it stands directly before the
    // frame.
    frames_kept_.push_back({message.arrival, static_cast<std::uint32_t>(exchanges - 1),
                            static_cast<std::uint8_t>(frame->sample_count), has_counter});
    for (std::size_t i = 0; i < frame->sample_count; ++i) {
      const NodeSample& sample = frame->samples[i];
      ages_us_.push_back(sample.age_us);
      content_.orientation |= sample.has_orientation;
      content_.acceleration |= sample.has_acceleration;
      content_.angular_velocity |= sample.has_angular_velocity;
      // A stream has one kind of acceleration. If one sample's acceleration excludes gravity, so
      // does the stream's, and samples that include gravity become invalid.
      if (sample.has_acceleration) content_.gravity &= sample.gravity_included;
    }
  }

  /// Fits the clock to the exchanges or, for a node without a counter, to the numbers of requests.
  Result<void> finish(const DeviceRequest& request, LearnedDevice& learned) override {
    if (exchanges_.empty() && clockless_.empty()) {
      return Failure(Error{request.file.path, 0, "frames of node " + learned.channel.node,
                           "none that the recorder accepted"});
    }
    learned.content = content_;
    // If the node has sent counters, its requests without a counter can't be stamped.
    // stamp_of_sample() leaves them out.
    if (exchanges_.empty()) {
      clockless_clock({clockless_.begin(), clockless_.end()}, request, learned);
    } else {
      const std::vector<Exchange> exchanges(exchanges_.begin(), exchanges_.end());
      learned.clock = device_clock(exchanges, learned.utc_minus_host);
    }
    return {};
  }

  /// Passes on the stamps of the samples, in the order in which NodeRows makes its rows.
  void stamp_rows(const LearnedDevice& learned, const TakeStamp& take) const override {
    RowsInOrder<std::monostate> stamps(most_overtaking_samples);
    const auto release = [&take](Time stamp, std::monostate) { take(stamp); };
    // The ages are read in the order in which take() stored them.
    auto age_us = ages_us_.begin();
    for (const KeptFrame& one : frames_kept_) {
      AcceptedFrame frame;
      if (one.has_counter) {
        const Exchange& accepted = exchanges_[one.exchange];
        frame.boot = accepted.boot;
        frame.n_tx = accepted.n_tx;
      } else {
        const ClocklessExchange& accepted = clockless_[one.exchange];
        frame.boot = accepted.boot;
        frame.number = number_of(accepted);
      }
      for (std::uint32_t i = 0; i < one.samples; ++i) {
        stamps.add(stamp_of_sample(learned, frame, *age_us++, one.arrival), {}, release);
      }
    }
    stamps.finish(release);
  }

 private:
  struct KeptFrame {
    HostTime arrival{};
    std::uint32_t exchange = 0;  // index of its exchange in exchanges_ or clockless_
    std::uint8_t samples = 0;
    bool has_counter = false;
  };
  // Deques are used, because a growing vector may occupy twice the needed memory.
  AcceptedFrames frames_;
  std::deque<KeptFrame> frames_kept_;
  std::deque<std::uint32_t> ages_us_;  // ages of all samples, in the order of the frames
  std::deque<Exchange> exchanges_;
  std::deque<ClocklessExchange> clockless_;
  ImuContent content_;
};

/// Makes one row for each sample of the node's accepted frames, in the order of stamps.
class NodeRows final : public DeviceRows<ImuSamples> {
 public:
  NodeRows(const DeviceRequest& request, std::shared_ptr<const LearnedDevice> learned)
      : DeviceRows(request.file.path),
        learned_(std::move(learned)),
        converter_(ImuUnits{axes_of(y_up, request.options), 1.0, 1.0}) {
    const RawChannel& channel = learned_->channel;
    const std::string& own = channel.place.empty() ? channel.node : channel.place;
    // The name in the manifest is preferred to the place in lab.toml, and the place to the id.
    header_.node_names = {request.file.node.empty() ? own : request.file.node};
    header_.content = learned_->content;
  }

  /// Stamps the samples of an accepted frame. If the clock of a sample is not known, the sample is
  /// left out and counted.
  Result<void> take(const RecordedMessage& message, ImuSamples& out) override {
    if (message.is_exchange()) {
      // The exchange itself is not needed, but must be decoded, because it shows that the next
      // frame was accepted.
      (void)frames_.take_exchange(message);
      return {};
    }
    const auto frame = frames_.take(message);
    if (!frame) return {};
    for (std::size_t i = 0; i < frame->sample_count; ++i) {
      const NodeSample& sample = frame->samples[i];
      waiting_.add(stamp_of_sample(*learned_, *frame, sample.age_us, message.arrival), sample,
                   appending(out));
    }
    return {};
  }

  /// Makes the remaining rows and adds findings about samples that were left out.
  Result<void> finish(ImuSamples& out) override {
    waiting_.finish(appending(out));
    converter_.report(file(), findings);
    note(frames_.others, "datagrams that the recorder could use",
         "datagrams that were damaged, late or duplicate, or of a session that was never confirmed",
         frames_.others == 1 ? "it was skipped" : "they were skipped");
    warn_too_late(waiting_, "samples");
    note(waiting_.unstamped(), "samples of sessions whose clock is known",
         "samples of other sessions", "these samples were left out");
    note(partial_, "samples with every quantity that the node sends",
         "samples that lack a quantity or have values that are not finite",
         "these samples are invalid");
    return {};
  }

  const ImuHeader* header() const override { return &header_; }

 private:
  std::function<void(Time, const NodeSample&)> appending(ImuSamples& out) {
    return [&](Time stamp, const NodeSample& sample) {
      out.stamps.push_back(stamp);
      append(sample, out);
    };
  }

  /// Appends one row. A sample is marked as invalid if it lacks a part of the stream's content, or
  /// if its kind of acceleration differs from the stream's.
  void append(const NodeSample& sample, ImuSamples& out) {
    const std::array<double, 4> q{sample.orientation[0], sample.orientation[1],
                                  sample.orientation[2], sample.orientation[3]};
    const std::array<double, 3> a{sample.acceleration[0], sample.acceleration[1],
                                  sample.acceleration[2]};
    const std::array<double, 3> w{sample.angular_velocity[0], sample.angular_velocity[1],
                                  sample.angular_velocity[2]};
    const ImuContent& content = header_.content;
    // The converter changes the axes and checks the quaternion. Absent quantities stay null.
    RawImuSample raw;
    if (content.orientation) raw.orientation = q.data();
    if (content.acceleration) raw.acceleration = a.data();
    if (content.angular_velocity) raw.angular_velocity = w.data();
    // A sample with the other kind of acceleration would have an error of 1 g.
    const bool mixed = sample.has_acceleration && sample.gravity_included != content.gravity;
    raw.valid = sample.has_orientation >= content.orientation &&
                sample.has_acceleration >= content.acceleration &&
                sample.has_angular_velocity >= content.angular_velocity && !mixed &&
                !faults(sample).not_finite;
    partial_ += raw.valid ? 0U : 1U;
    converter_.append(raw, out);
  }

  std::shared_ptr<const LearnedDevice> learned_;
  ImuConverter converter_;
  ImuHeader header_;
  AcceptedFrames frames_;
  RowsInOrder<NodeSample> waiting_{most_overtaking_samples};
  std::uint64_t partial_ = 0;
};

}  // namespace

DeviceProtocol node_protocol() { return device_protocol<NodeListener, NodeRows>(); }

}  // namespace kinalign
