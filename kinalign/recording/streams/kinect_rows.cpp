// SPDX-License-Identifier: Apache-2.0
// Makes the rows of a Kinect. The sensor's ticks are converted to UTC in two steps, because the
// sensor itself can't answer pings. The sender's clock gives the time at which the sender received
// each frame. Pings relate the sender's clock to the host's clock. All stamps are late by the
// shortest delay from the sensor to the sender.
#include "kinalign/protocols/kinect/frames.h"
#include "kinalign/recording/frames/kinect_frames.h"
#include "kinalign/recording/streams/device_rows.h"
#include "kinalign/recording/streams/kinect_person.h"
#include "kinalign/recording/streams/rows_in_order.h"
#include "kinalign/wire/little_endian_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <variant>

namespace kinalign {

namespace {

/// The times of a frame on each clock: the sensor's (`device`), the sender's at receiving
/// (`sender`) and at sending (`sent`), and the host's (`arrival`).
struct Taken {
  BootKey boot = 0;  // the session; later the key of its clock model
  NodeTime device{}, sender{}, sent{};
  HostTime arrival{};  // arrival of the message that contained the part or completed the frame
};
Taken taken_of(const KinectFrame& frame, HostTime arrival) {
  return {frame.origin.session, kinect_sender_time(frame.device_ticks),
          kinect_sender_time(frame.taken_ticks), kinect_sender_time(frame.sent_ticks), arrival};
}

/// True if `a` arrived at the host before `b`. device_clock() needs this order.
bool came_before(const Exchange& a, const Exchange& b) { return a.h_rx < b.h_rx; }

/// The stamp of a frame; empty if its clock is not known.
std::optional<Time> stamp_of_frame(const LearnedDevice& learned, const Taken& one) {
  const BootKey boot = learned.epochs.boot_at(one.boot, one.sent, one.arrival);
  return stamp_of(learned.clock, boot, one.device, one.arrival);
}

constexpr std::size_t most_overtaking_kinect_frames =
    16;  // half a second; no network delays a frame for longer

/// Learns both clocks of a Kinect and keeps the times of its frames. Each frame is also a one-way
/// exchange for the sender's clock.
class KinectListener final : public DeviceListener {
 public:
  explicit KinectListener(std::optional<std::uint64_t>) {}

  /// Keeps the exchanges, the times of each part, and the times of each complete frame.
  void take(const RecordedMessage& message) override {
    if (message.is_exchange()) {
      if (const auto recorded = to_exchange(message.payload)) {
        epochs_.add(*recorded);
        exchanges_.push_back(recorded->exchange);
        // The number of the epoch is part of the key, because the host's clock jumps between
        // epochs.
        exchanges_.back().boot = boot_in_epoch(recorded->exchange.boot, recorded->epoch);
      }
      return;
    }
    parts_.clear();
    joined_.clear();
    frames_.take(message, joined_, &parts_);
    for (const KinectFrame& part : parts_) taken_.push_back(taken_of(part, message.arrival));
    arrival_ = message.arrival;
    add_joined();
  }

  /// First fits the sender's clock to the pings and to the arrivals of frames. Then fits the
  /// sensor's clock to the times at which the sender received its frames.
  Result<void> finish(const DeviceRequest& request, LearnedDevice& learned) override {
    if (taken_.empty())
      return Failure(no_rows_error("frames of a Kinect", request.file.path, learned));
    joined_.clear();
    frames_.finish(joined_);
    add_joined();
    // All epochs are known now, so each frame gets its own.
    for (Taken& one : taken_) {
      one.boot = epochs_.boot_at(one.boot, one.sent, one.arrival);
      exchanges_.push_back({one.boot, one.sent, one.arrival, std::nullopt});
    }
    std::stable_sort(exchanges_.begin(), exchanges_.end(), came_before);
    // The sender's clock is converted to the host's clock only. The second fit uses these host
    // times as arrivals of the sensor's frames.
    const DeviceClock sender = device_clock(exchanges_, {});
    std::vector<Exchange> from_sensor;
    from_sensor.reserve(taken_.size());
    for (const Taken& one : taken_) {
      const auto at = host_from_node(sender.model, one.boot, one.sender, one.arrival);
      // A part is skipped if its session has no clock.
      if (at) from_sensor.push_back({one.boot, one.device, at->time, std::nullopt});
    }
    std::stable_sort(from_sensor.begin(), from_sensor.end(), came_before);
    learned.clock = device_clock(from_sensor, learned.utc_minus_host);
    learned.epochs = std::move(epochs_);
    // The times of all parts take much memory and are not needed any more.
    taken_ = {};
    exchanges_ = {};
    return {};
  }

  void stamp_rows(const LearnedDevice& learned, const TakeStamp& take) const override {
    // A frame without a stamp gives no row. KinectRows does the same.
    RowsInOrder<std::monostate> stamps(most_overtaking_kinect_frames);
    const auto release = [&take](Time stamp, std::monostate) { take(stamp); };
    for (const Taken& one : rows_) stamps.add(stamp_of_frame(learned, one), {}, release);
    stamps.finish(release);
  }

 private:
  void add_joined() {
    for (const JoinedKinectFrame& one : joined_) rows_.push_back(taken_of(one.frame, arrival_));
  }

  HostTime arrival_{};
  std::vector<Taken> rows_;  // times of complete frames, stamped when the clocks are known
  KinectFrames frames_;
  std::vector<KinectFrame> parts_;
  std::vector<JoinedKinectFrame> joined_;
  std::vector<Exchange> exchanges_;  // from pings; finish() adds those from frames
  HostEpochs epochs_;
  std::vector<Taken> taken_;
};

/// Makes one row for each complete frame, in the order of stamps. A row contains the joints of the
/// followed person. If the person is not in the frame, the row has no joints.
class KinectRows final : public DeviceRows<PointFrames> {
 public:
  KinectRows(const DeviceRequest& request, std::shared_ptr<const LearnedDevice> learned)
      : DeviceRows(request.file.path), learned_(std::move(learned)), person_(request.body) {
    header_.joint_names.assign(kinect_joints.begin(), kinect_joints.end());
  }

  Result<void> take(const RecordedMessage& message, PointFrames& out) override {
    if (message.is_exchange()) return {};
    joined_.clear();
    frames_.take(message, joined_, nullptr);
    arrival_ = message.arrival;
    add_joined(out);
    return {};
  }

  /// Makes the remaining rows and adds findings about frames that were left out.
  Result<void> finish(PointFrames& out) override {
    joined_.clear();
    frames_.finish(joined_);
    add_joined(out);
    waiting_.finish(appending(out));
    person_.report(file(), findings);
    const KinectFrameCounts counts = frames_.counts();
    note(counts.frames.lost, "frame numbers without a gap", "frames missing",
         "these frames were lost on the network");
    warn_too_late(waiting_, "frames");
    if (frames_.overlap()) {
      findings.push_back(overlap_finding(
          file(), *frames_.overlap(),
          fmt::format(
              "frames of the newest session were read; {} frames of other sessions were left out",
              counts.stale)));
    } else {
      note(counts.stale, "frames of the sender's newest session", "frames of earlier sessions",
           "these late frames were left out");
    }
    note(counts.parts_lost, "all parts of each frame", "frames with missing parts",
         "these frames may lack bodies");
    note(frames_.of_other_sensors, "frames of one sensor", "frames of other sensors",
         "these frames were left out");
    note(waiting_.unstamped(), "frames whose clock is known", "frames without a known clock",
         "these frames were left out");
    note(not_finite_, "joints with finite positions", "joints with other values",
         "these joints are missing");
    return {};
  }

  const PointHeader* header() const override { return &header_; }

 private:
  void add_joined(PointFrames& out) {
    for (JoinedKinectFrame& one : joined_) {
      const auto stamp = stamp_of_frame(*learned_, taken_of(one.frame, arrival_));
      waiting_.add(stamp, std::move(one.frame), appending(out));
    }
  }
  // Rows are made when frames leave the queue. The person is therefore followed in the order of
  // time.
  std::function<void(Time, const KinectFrame&)> appending(PointFrames& out) {
    return [&](Time stamp, const KinectFrame& frame) {
      not_finite_ += append_kinect_row(frame, person_(frame).value_or(0), out);
      out.stamps.back() = stamp;
    };
  }

  std::shared_ptr<const LearnedDevice> learned_;
  KinectPerson person_;
  PointHeader header_;
  KinectFrames frames_;
  std::vector<JoinedKinectFrame> joined_;
  RowsInOrder<KinectFrame> waiting_{most_overtaking_kinect_frames};
  HostTime arrival_{};
  std::uint64_t not_finite_ = 0;
};

}  // namespace

DeviceProtocol kinect_protocol() { return device_protocol<KinectListener, KinectRows>(); }

}  // namespace kinalign
