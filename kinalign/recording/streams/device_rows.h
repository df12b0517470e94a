// SPDX-License-Identifier: Apache-2.0
// Converts the messages of a recorded device to rows. A first pass over the messages learns the
// device's clock. Later passes stamp the rows with this clock.
#pragma once

#include "kinalign/clock/offline/device_clock.h"
#include "kinalign/formats/reader.h"
#include "kinalign/recording/format.h"
#include "kinalign/recording/streams/host_epochs.h"
#include "kinalign/recording/streams/rows_in_order.h"
#include "kinalign/take/manifest.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

namespace kinalign {

/// Selects one device of a recording. When the recording is known, SenderTable::complete() and
/// choose() (recording_source.cpp) fill in the fields that the user left open.
struct DeviceChoice {
  std::string stream;
  std::string node;    // for inertial nodes: an id, or a place in lab.toml; empty: the only node
  std::string sender;  // address with or without port; empty: the busiest sender
  std::set<std::string> left_out{};  // senders at this address that are not read

  bool operator==(const DeviceChoice&) const = default;
};

/// Describes the rows to make: the device and the options.
struct DeviceRequest {
  StreamOptions options;
  StreamFile file;
  DeviceChoice choice;
  std::string skeleton{};  // the head of the BVH file in the options, if any
  /// The body of a Kinect, the avatar or character of mocap, or the sensor of a SlimeVR tracker.
  std::optional<std::uint64_t> body{};
  bool trackers = false;  // for Xsens: inertial samples instead of poses
};

/// Reads the selection of a stream in a manifest. select["stream"] is the recorded stream; its
/// default is the stream's own name. select["node"] has the file's node as default.
/// select["sender"], select["body"] and select["kind"] may select further. A tracker's node is its
/// address; "/1" after the address selects sensor 1. Fails if a key is unknown or a body is not a
/// number.
Result<DeviceRequest> request_of(const StreamOptions& options, const StreamFile& file);

/// The result of the first pass over a device's messages. It is complete before the first row is
/// made, and all later passes use it.
struct LearnedDevice {
  RawChannel channel;
  std::string skeleton;  // the head of a BVH file; empty: the recording has none
  Duration utc_minus_host{};
  DeviceClock clock;
  double step_ns = 0.0;     // time between counted frames, or between frames in one datagram, ns
  bool by_arrival = false;  // the data have no time or number; stamps are arrivals in UTC
  ImuContent content;       // for inertial nodes only
  HostEpochs epochs;        // for Kinects only
  Findings findings;
};

/// The error for a device without rows. `what`: the content that rows need. `others`: the number of
/// messages of this protocol with other content. `refused`: findings about frames that the decoder
/// refused.
inline Error no_rows_error(std::string_view what, const std::string& file,
                           const LearnedDevice& learned, std::uint64_t others = 0,
                           const Findings& refused = {}) {
  const std::string expected = std::string(what) + " in stream " + shown(learned.channel.stream);
  if (others > 0) {
    return {file, 0, expected, std::to_string(others) + " messages, all of other types or bodies",
            ErrorKind::no_rows_in_recording};
  }
  // The decoder knows why it refused all frames, so the port and the protocol are not the fault.
  if (!refused.empty()) {
    const Finding& first = refused.front();
    const std::string advice = first.repair.empty() ? first.meaning : first.repair;
    return {file, 0, expected + " (" + advice + ")", "only refused ones: " + first.what.found,
            ErrorKind::no_rows_in_recording};
  }
  return {file, 0,
          expected +
              " (no message is of this protocol: check the port and the protocol that the device "
              "sends to)",
          "none", ErrorKind::no_rows_in_recording};
}

/// For a device whose packets contain no time, and no number that could replace a time.
inline void stamp_by_arrival(const std::string& file, LearnedDevice& learned) {
  learned.by_arrival = true;
  learned.findings.push_back(
      {Severity::note, Error{file, 0, "a time or a number in each packet", "neither"},
       "samples are stamped by their arrival, so the stamps are late by an unknown delay",
       "if the delay is known, set a negative offset_ms"});
}

/// The first pass over a device's messages: learns how to stamp the rows. It only keeps what the
/// clock and the stamps need, because recordings may last for hours.
class DeviceListener {
 public:
  using TakeStamp = std::function<void(Time)>;

  virtual ~DeviceListener() = default;
  virtual void take(const RecordedMessage& message) = 0;
  /// Call this once after the last message. `learned` already contains channel, skeleton and
  /// utc_minus_host. Fails if no rows can be made.
  virtual Result<void> finish(const DeviceRequest& request, LearnedDevice& learned) = 0;
  /// Call this after finish(). Calls `take` with the stamp of each row that DeviceRows makes, in
  /// the same order.
  virtual void stamp_rows(const LearnedDevice& learned, const TakeStamp& take) const = 0;
};

/// A later pass over the same messages: makes the rows. After a failure the object must not be used
/// again. There must be exactly one row for each stamp of DeviceListener::stamp_rows(), because the
/// take's number of rows follows from these stamps.
template <class Frames>
class DeviceRows {
 public:
  using Header = std::conditional_t<
      std::is_same_v<Frames, ClipFrames>, Skeleton,
      std::conditional_t<std::is_same_v<Frames, PointFrames>, PointHeader, ImuHeader>>;
  /// `file`: the name of the file, for messages.
  explicit DeviceRows(std::string file) : file_(std::move(file)) {}
  virtual ~DeviceRows() = default;
  virtual Result<void> take(const RecordedMessage& message, Frames& out) = 0;
  virtual Result<void> finish(Frames& out) = 0;
  /// The header; nullptr before the first row if the header depends on that row.
  virtual const Header* header() const = 0;
  Findings findings;  // complete after finish()

 protected:
  const std::string& file() const { return file_; }
  /// Adds a note, unless `count` is 0.
  void note(std::uint64_t count, std::string_view expected, std::string_view found,
            std::string_view meaning) {
    if (count == 0) return;
    findings.push_back(
        {Severity::note,
         Error{file_, 0, std::string(expected), std::to_string(count) + " " + std::string(found)},
         std::string(meaning), ""});
  }
  /// Adds a warning if rows came too late. `rows`: a word for the rows.
  template <class Row>
  void warn_too_late(const RowsInOrder<Row>& order, std::string_view rows) {
    if (order.too_late() == 0) return;
    findings.push_back({Severity::warning,
                        Error{file_, 0,
                              std::string(rows) + " that arrive after at most " +
                                  std::to_string(order.most_reordered()) + " newer ones",
                              std::to_string(order.too_late()) + " that arrived later"},
                        "they were left out",
                        "check the network, and whether the clock of the device's "
                        "stamps stepped back"});
  }

 private:
  std::string file_;
};

using AnyDeviceRows =
    std::variant<std::unique_ptr<DeviceRows<ClipFrames>>, std::unique_ptr<DeviceRows<PointFrames>>,
                 std::unique_ptr<DeviceRows<ImuSamples>>>;

/// The functions that make rows of one protocol.
struct DeviceProtocol {
  std::unique_ptr<DeviceListener> (*listen)(std::optional<std::uint64_t> body);
  AnyDeviceRows (*rows)(const DeviceRequest& request, std::shared_ptr<const LearnedDevice> learned);
};
/// The functions of a Listener and a Rows class. `body` in them: see DeviceRequest.
template <class Listener, class Rows>
DeviceProtocol device_protocol() {
  return {[](std::optional<std::uint64_t> body) -> std::unique_ptr<DeviceListener> {
            return std::make_unique<Listener>(body);
          },
          [](const DeviceRequest& request, std::shared_ptr<const LearnedDevice> learned)
              -> AnyDeviceRows { return std::make_unique<Rows>(request, std::move(learned)); }};
}

/// The result is empty if the protocol is not known, or if trackers are wanted but the protocol has
/// none.
std::optional<DeviceProtocol> rows_of(std::optional<Protocol> protocol, bool trackers);

DeviceProtocol node_protocol();           // node_rows.cpp: kinalign's inertial nodes
DeviceProtocol kinect_protocol();         // kinect_rows.cpp: Kinects
DeviceProtocol noitom_protocol();         // noitom_rows.cpp: poses of Noitom's suits
DeviceProtocol xsens_protocol();          // xsens_rows.cpp: poses of Xsens MVN
DeviceProtocol xsens_tracker_protocol();  // xsens_rows.cpp: inertial samples
DeviceProtocol slimevr_protocol();        // slimevr_rows.cpp: SlimeVR trackers

}  // namespace kinalign
