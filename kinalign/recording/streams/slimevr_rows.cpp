// SPDX-License-Identifier: Apache-2.0
// Makes rows of one sensor of a SlimeVR tracker. A row is a rotation, with the acceleration that
// arrived with it or just before. The packets contain no time, so stamps are arrivals.
#include "kinalign/formats/imu_converter.h"
#include "kinalign/protocols/sequence_count.h"
#include "kinalign/protocols/slimevr/packet.h"
#include "kinalign/recording/streams/device_rows.h"
#include "kinalign/recording/streams/senders.h"
#include "kinalign/wire/little_endian_reader.h"

#include <fmt/format.h>

#include <map>
#include <set>

namespace kinalign {

namespace {

/// An acceleration belongs to the next rotation if that arrives within this time.
constexpr Duration goes_with = std::chrono::milliseconds(50);

/// One rotation, with the acceleration that belongs to it, if any.
struct SlimeSample {
  std::array<double, 4> orientation{};
  std::optional<std::array<double, 3>> acceleration;
};

/// Collects the samples of one sensor. Late and duplicate datagrams of each sender are left out.
class SlimeSamples {
 public:
  explicit SlimeSamples(std::optional<std::uint64_t> sensor) : sensor_(sensor) {}

  /// Appends the samples that a datagram completes. A handshake resets the sender's numbers.
  void take(const RecordedMessage& message, std::vector<SlimeSample>& out) {
    SlimeDatagram datagram;
    if (!decode_slime(octets(message.payload), datagram)) return;
    Tracker& tracker = trackers_[message.channel_id];
    // Handshakes are handled first, because a datagram may also contain other packets.
    for (const SlimePacket& packet : datagram.packets) {
      if (const auto* handshake = std::get_if<SlimeHandshake>(&packet)) {
        tracker = {};
        tracker.protocol = handshake->protocol.value_or(0);
      }
    }
    // A datagram with the number 0 has no place in the count, so it can't be late.
    if (datagram.number != 0 && is_old(tracker.numbers.push(datagram.number))) {
      ++overtaken;
      return;
    }
    for (const SlimePacket& packet : datagram.packets) {
      const auto* motion = std::get_if<SlimeMotion>(&packet);
      if (motion == nullptr || motion->is_correction) continue;
      if (sensors.size() < most_sensors) sensors.insert(motion->sensor);
      if (!sensor_) sensor_ = motion->sensor;
      if (motion->sensor == *sensor_) tracker.add(*motion, message.arrival, out);
    }
  }

  /// The number of late and duplicate datagrams.
  std::uint64_t overtaken = 0;
  std::set<unsigned> sensors;  // sensors with at least one rotation or acceleration

 private:
  static constexpr std::size_t most_sensors = 32;

  // The state of one sender. The protocol version determines the axes of accelerations.
  struct Tracker {
    SequenceCount numbers{64};
    std::int32_t protocol = 0;
    std::optional<std::array<double, 3>> acceleration{};
    HostTime felt{};

    /// Keeps an acceleration until the next rotation. A rotation completes a sample with the
    /// acceleration.
    void add(const SlimeMotion& motion, HostTime arrival, std::vector<SlimeSample>& out) {
      if (motion.acceleration) {
        acceleration = slime_acceleration(*motion.acceleration, protocol);
        felt = arrival;
      }
      if (!motion.rotation) return;
      const auto q = slime_orientation(*motion.rotation);
      if (!q) return;
      // An older acceleration does not belong to the time of this rotation.
      const bool fresh = acceleration && arrival - felt <= goes_with;
      out.push_back({*q, fresh ? acceleration : std::nullopt});
      acceleration.reset();
    }
  };
  static bool is_old(Order order) { return order == Order::late || order == Order::duplicate; }

  std::optional<std::uint64_t> sensor_;
  std::map<std::uint16_t, Tracker> trackers_;  // one for each channel
};

Time stamp_at(HostTime arrival, const LearnedDevice& learned) {
  return Time{arrival.time_since_epoch() + learned.utc_minus_host};
}

/// Counts samples and keeps their arrivals, which are the stamps.
class SlimeListener final : public DeviceListener {
 public:
  explicit SlimeListener(std::optional<std::uint64_t> sensor)
      : any_sensor_(!sensor), samples_(sensor) {}

  void take(const RecordedMessage& message) override {
    taken_.clear();
    samples_.take(message, taken_);
    arrivals_.insert(arrivals_.end(), taken_.size(), message.arrival);
    for (const SlimeSample& one : taken_) accelerations_ += one.acceleration ? 1U : 0U;
  }

  Result<void> finish(const DeviceRequest& request, LearnedDevice& learned) override {
    const std::string& file = request.file.path;
    if (arrivals_.empty()) {
      return Failure(Error{
          file, 0, "rotations of a SlimeVR tracker in stream " + shown(learned.channel.stream),
          "none", ErrorKind::no_rows_in_recording});
    }
    stamp_by_arrival(file, learned);
    // A tracker may send few accelerations. If at most half of the samples have one, the stream has
    // no acceleration.
    learned.content = {true, 2 * accelerations_ > arrivals_.size(), false, false};
    if (any_sensor_ && samples_.sensors.size() > 1) {
      learned.findings.push_back(
          {Severity::warning,
           Error{file, 0, "one sensor of tracker " + host_of(learned.channel.sender),
                 fmt::format("{} sensors", samples_.sensors.size())},
           "only the sensor that sent first was read",
           fmt::format("to read another sensor, use a node name such as {}/{}",
                       host_of(learned.channel.sender), *samples_.sensors.rbegin())});
    }
    return {};
  }

  void stamp_rows(const LearnedDevice& learned, const TakeStamp& take) const override {
    for (const HostTime arrival : arrivals_) take(stamp_at(arrival, learned));
  }

 private:
  bool any_sensor_;
  SlimeSamples samples_;
  std::vector<SlimeSample> taken_;
  std::vector<HostTime> arrivals_;  // arrivals of the samples
  std::uint64_t accelerations_ = 0;
};

/// Makes a row for each sample. SlimeListener uses the same SlimeSamples, so stamps and rows agree.
class SlimeRows final : public DeviceRows<ImuSamples> {
 public:
  SlimeRows(const DeviceRequest& request, std::shared_ptr<const LearnedDevice> learned)
      : DeviceRows(request.file.path),
        learned_(std::move(learned)),
        samples_(request.body),
        converter_(ImuUnits{}) {
    header_.node_names = {request.file.node.empty() ? host_of(learned_->channel.sender)
                                                    : request.file.node};
    header_.content = learned_->content;
  }

  /// Makes a row for each sample. If the stream has accelerations, a sample without an acceleration
  /// is marked as invalid.
  Result<void> take(const RecordedMessage& message, ImuSamples& out) override {
    taken_.clear();
    samples_.take(message, taken_);
    for (const SlimeSample& one : taken_) {
      RawImuSample raw;
      raw.orientation = one.orientation.data();
      const std::array<double, 3> none{};
      if (header_.content.acceleration) {
        raw.acceleration = one.acceleration ? one.acceleration->data() : none.data();
        raw.valid = one.acceleration.has_value();
      }
      out.stamps.push_back(stamp_at(message.arrival, *learned_));
      converter_.append(raw, out);
    }
    return {};
  }

  Result<void> finish(ImuSamples&) override {
    note(samples_.overtaken, "datagrams with rising numbers", "late or duplicate datagrams",
         "they were left out, because the time of their samples is unknown");
    return {};
  }

  const ImuHeader* header() const override { return &header_; }

 private:
  std::shared_ptr<const LearnedDevice> learned_;
  SlimeSamples samples_;
  ImuConverter converter_;
  ImuHeader header_;
  std::vector<SlimeSample> taken_;
};

}  // namespace

DeviceProtocol slimevr_protocol() { return device_protocol<SlimeListener, SlimeRows>(); }

}  // namespace kinalign
