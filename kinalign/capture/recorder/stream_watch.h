// SPDX-License-Identifier: Apache-2.0
// What one sender's bytes are while they are recorded: frames, what was lost, late or doubled by
// the sender's own numbers, what could not be read. The bytes are recorded whatever this says.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/protocols/kinect/frames.h"
#include "kinalign/protocols/kinect/stream.h"
#include "kinalign/protocols/noitom/receiver.h"
#include "kinalign/protocols/protocols.h"
#include "kinalign/protocols/xsens/stream.h"
#include "kinalign/recording/counts.h"

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kinalign {

/// Of a port's Kinects, by sensor: their sessions, whichever of its senders brought them.
using NewestKinectFrames = std::map<std::uint32_t, KinectSessions>;

class StreamWatch {
 public:
  /// Nothing is counted for a protocol that is decoded elsewhere. `datagrams`: a piece is one, with
  /// whole messages in it; else bytes cut anywhere. `sender`: as findings name it.
  explicit StreamWatch(Protocol protocol, bool datagrams = false, const std::string& sender = "");

  /// `newest`: a Kinect that is heard on another way than before, in a connection made anew, goes
  /// on with its count, or has been started anew.
  void feed(std::string_view piece, HostTime arrival, NewestKinectFrames& newest);
  /// Of a Kinect's sender: the pings that the last piece completed, and how pongs are to look.
  std::span<const KinectPing> pings() const;
  bool speaks_lines() const;
  /// Whether another sender speaks beside this one with its sensor's id.
  bool has_twins() const;
  /// Of its frames: messages and bytes are the caller's.
  SenderCounts counts() const;
  /// What the user should know; `name` stands in the messages.
  Findings findings(const std::string& name) const;

 private:
  struct Noitom {
    NoitomReceiver decoder{NoitomParts::heads};
    std::vector<NoitomArrival> frames{};
    bool datagrams = false;
  };
  struct Xsens {
    XsensDecoder decoder;
    std::vector<XsensArrival> samples{};
  };
  struct KinectSensor {
    KinectFrameJoiner joiner{};
    std::optional<std::uint32_t> restarted{};  // the session before this sender's first one
  };
  struct Kinect {
    KinectStreamDecoder decoder;
    std::vector<KinectMessage> messages{};
    std::map<std::uint32_t, KinectSensor> sensors{};  // as many as most_sensors
    std::vector<JoinedKinectFrame> frames{};
    std::uint64_t whole = 0, further_sensors = 0;  // frames; messages of one sensor too many
    std::uint64_t late = 0;                        // of a session that another sender's has ended
    std::vector<KinectTwins> twins{};              // that were found by this sender's frames
    std::vector<KinectPing> pings{};
    bool datagrams = false;
    std::string sender{};
  };
  struct Piece {
    std::span<const std::uint8_t> bytes;
    HostTime arrival;
  };
  static void feed(Noitom& noitom, const Piece& piece, NewestKinectFrames& newest);
  static void feed(Xsens& xsens, const Piece& piece, NewestKinectFrames& newest);
  static void feed(Kinect& kinect, const Piece& piece, NewestKinectFrames& newest);
  static void count(Kinect& kinect, KinectFrame frame, NewestKinectFrames& newest);
  static KinectSensor sensor_behind(const KinectSessions& sessions, std::uint32_t session);
  static SenderCounts counts(const Noitom& noitom);
  static SenderCounts counts(const Xsens& xsens);
  static SenderCounts counts(const Kinect& kinect);

  std::variant<std::monostate, Noitom, Xsens, Kinect> decoder_;
  std::uint64_t refused_ = 0;  // pieces with what is no frame in them
};

}  // namespace kinalign
