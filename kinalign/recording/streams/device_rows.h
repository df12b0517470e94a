// SPDX-License-Identifier: Apache-2.0
// From the messages of a recorded device to rows: a first pass learns the device's clock, later
// passes stamp rows by it.
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

/// Which device of a recording.
struct DeviceChoice {
  std::string stream;
  std::string node;  // of inertial nodes: an id, or a place where the lab named it; empty: the only
  std::string sender;  // the address, with its port or without; empty: the one that sent most
  std::set<std::string> passed_over{};  // senders at that address that are not taken

  bool operator==(const DeviceChoice&) const = default;
};

/// What rows are asked for.
struct DeviceWish {
  StreamOptions options;
  StreamFile file;
  DeviceChoice choice;
  std::string skeleton{};  // a BVH's header, where the options name one
  /// Of a Kinect; avatar or character of mocap; a SlimeVR tracker's sensor.
  std::optional<std::uint64_t> body{};
  bool trackers = false;  // of Xsens: inertial samples, not poses
};

/// The wish of a stream of a manifest: select["stream"], by default the options' name;
/// select["node"], by default the file's node; select["sender"], select["body"], select["kind"]. A
/// tracker's node is its address, with "/1" behind it its sensor 1. Fails where a key or a body is
/// none.
Result<DeviceWish> wish_of(const StreamOptions& options, const StreamFile& file);

/// What listening has found.
struct HeardDevice {
  RawChannel channel;
  std::string skeleton;  // a BVH's header, where the recording has one
  Duration utc_minus_host{};
  DeviceClock clock;
  double step_ns = 0.0;     // of frames that are counted, or come in one datagram
  bool by_arrival = false;  // of devices that say no time and no number: stamps are UTC of arrival
  ImuContent content;       // of a node
  HostEpochs epochs;        // of a Kinect
  Findings findings;
};

/// `what`: what rows would be made of. `others`: what came of the protocol and is something else.
inline Error nothing_of(std::string_view what, const std::string& file, const HeardDevice& heard,
                        std::uint64_t others = 0) {
  const std::string expected = "of stream " + shown(heard.channel.stream) + " " + std::string(what);
  if (others > 0) {
    return {file, 0, expected, std::to_string(others) + " of other types or bodies alone",
            ErrorKind::no_rows_in_recording};
  }
  return {file, 0,
          expected +
              " (nothing in it is of that protocol: see which port and protocol the device "
              "sends to)",
          "none", ErrorKind::no_rows_in_recording};
}

/// Of a device whose packets say no time, and no number that could stand for it.
inline void stamp_by_arrival(const std::string& file, HeardDevice& heard) {
  heard.by_arrival = true;
  heard.findings.push_back(
      {Severity::note, Error{file, 0, "packets that say when they were measured", "none that do"},
       "stamps are arrivals, late by unknown times", "offset_ms takes off a delay that is known"});
}

/// Learns from a device's messages what its rows need to be stamped: the first pass.
class DeviceListener {
 public:
  using TakeStamp = std::function<void(Time)>;

  virtual ~DeviceListener() = default;
  virtual void take(const RecordedMessage& message) = 0;
  /// After the last message, once. `heard` has channel, skeleton and utc_minus_host. Fails where no
  /// rows could be made.
  virtual Result<void> finish(const DeviceWish& wish, HeardDevice& heard) = 0;
  /// After finish(): the stamp of each row that DeviceRows makes, in their order.
  virtual void stamp_rows(const HeardDevice& heard, const TakeStamp& take) const = 0;
};

/// The stamps of rows in the order that RowsInOrder brings them into. `Row`: what is known of a
/// row.
template <class Row>
class OrderedStamps {
 public:
  OrderedStamps(std::size_t most_overtaking, std::function<void(Time, const Row&)> take)
      : waiting_(most_overtaking), take_(std::move(take)) {}
  void add(Time stamp, Row row) { waiting_.add(stamp, std::move(row)); }
  /// A message has ended: what need not wait any more is taken.
  void settle() {
    while (const auto first = waiting_.take_first()) take_(first->first, first->second);
  }
  void finish() {
    waiting_.finish();
    settle();
  }

 private:
  RowsInOrder<Row> waiting_;
  std::function<void(Time, const Row&)> take_;
};

/// Makes rows of the same messages: each later pass. After a failure it may not be used again.
template <class Frames>
class DeviceRows {
 public:
  using Header = std::conditional_t<
      std::is_same_v<Frames, ClipFrames>, Skeleton,
      std::conditional_t<std::is_same_v<Frames, PointFrames>, PointHeader, ImuHeader>>;
  /// `file`: its name, for messages.
  explicit DeviceRows(std::string file) : file_(std::move(file)) {}
  virtual ~DeviceRows() = default;
  virtual Result<void> take(const RecordedMessage& message, Frames& out) = 0;
  virtual Result<void> finish(Frames& out) = 0;
  /// nullptr where the first row has to say it.
  virtual const Header* header() const = 0;
  Findings findings;  // complete after finish()

 protected:
  const std::string& file() const { return file_; }
  /// A note, unless the count is 0.
  void tell(std::uint64_t count, std::string_view expected, std::string_view found,
            std::string_view meaning) {
    if (count == 0) return;
    findings.push_back(
        {Severity::note,
         Error{file_, 0, std::string(expected), std::to_string(count) + " " + std::string(found)},
         std::string(meaning), ""});
  }
  /// `rows`: what they are, in words. A warning, unless none came too late.
  template <class Row>
  void tell_too_late(const RowsInOrder<Row>& order, std::string_view rows) {
    if (order.too_late() == 0) return;
    findings.push_back({Severity::warning,
                        Error{file_, 0,
                              std::string(rows) + " that at most " +
                                  std::to_string(order.most_overtaking()) + " others overtake",
                              std::to_string(order.too_late()) + " that came later still"},
                        "they were left out",
                        "look at the network that they come by, and whether the clock of their "
                        "stamps stepped back"});
  }

 private:
  std::string file_;
};

using AnyDeviceRows =
    std::variant<std::unique_ptr<DeviceRows<ClipFrames>>, std::unique_ptr<DeviceRows<PointFrames>>,
                 std::unique_ptr<DeviceRows<ImuSamples>>>;

/// A protocol that rows can be made of.
struct DeviceProtocol {
  std::unique_ptr<DeviceListener> (*listen)(std::optional<std::uint64_t> body);
  AnyDeviceRows (*rows)(const DeviceWish& wish, std::shared_ptr<const HeardDevice> heard);
};
/// `body`: which one of several, see DeviceWish.
template <class Listener, class Rows>
DeviceProtocol device_protocol() {
  return {[](std::optional<std::uint64_t> body) -> std::unique_ptr<DeviceListener> {
            return std::make_unique<Listener>(body);
          },
          [](const DeviceWish& wish, std::shared_ptr<const HeardDevice> heard) -> AnyDeviceRows {
            return std::make_unique<Rows>(wish, std::move(heard));
          }};
}

/// By the name that recordings have; absent where no rows, or no trackers, can be made of it.
std::optional<DeviceProtocol> rows_of(const std::string& recorded_name, bool trackers);

DeviceProtocol node_protocol();           // node_rows.cpp: inertial nodes of ours
DeviceProtocol kinect_protocol();         // kinect_rows.cpp
DeviceProtocol noitom_protocol();         // noitom_rows.cpp
DeviceProtocol xsens_protocol();          // xsens_rows.cpp: poses
DeviceProtocol xsens_tracker_protocol();  // inertial samples out of the same stream
DeviceProtocol slimevr_protocol();        // slimevr_rows.cpp

}  // namespace kinalign
