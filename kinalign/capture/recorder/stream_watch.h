// SPDX-License-Identifier: Apache-2.0
// Counts one sender's data during recording: frames, lost, late and duplicate ones by the sender's
// own numbers, and data that cannot be read. The bytes are recorded in any case.
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

/// The sessions of a port's Kinects, by sensor id, whichever sender brought them.
using NewestKinectFrames = std::map<std::uint32_t, KinectSessions>;

/// Decodes only as much as counting needs. What it says never changes what is recorded.
class StreamWatch {
 public:
  /// Protocols that are decoded elsewhere are not counted. `datagrams`: each piece is a datagram
  /// with whole messages; otherwise pieces may end anywhere. `sender`: its name in findings.
  explicit StreamWatch(Protocol protocol, bool datagrams = false, const std::string& sender = "");

  /// Decodes one piece. `newest`: the sessions of the port's Kinects. If a Kinect returns over a
  /// new connection, its count continues, or it is recognised as restarted.
  void feed(std::string_view piece, HostTime arrival, NewestKinectFrames& newest);
  /// The pings of a Kinect's sender that the last piece completed.
  std::span<const KinectPing> pings() const;
  /// Whether the sender uses lines; pongs must use the same form.
  bool speaks_lines() const;
  /// Returns whether another sender uses the same sensor id at the same time.
  bool has_overlap() const;
  /// Counts of frames. The caller counts messages and bytes.
  SenderCounts counts() const;
  /// Findings about this sender. `name` appears in the messages.
  Findings findings(const std::string& name) const;

 private:
  /// One of these per sender, by protocol. The vectors are members to keep their memory from piece
  /// to piece.
  struct Noitom {
    NoitomReceiver decoder{NoitomParts::heads};
    std::vector<NoitomArrival> frames{};
    bool datagrams = false;
  };
  struct Xsens {
    XsensDecoder decoder;
    std::vector<XsensArrival> samples{};
  };
  struct Kinect {
    KinectStreamDecoder decoder;
    std::vector<KinectMessage> messages{};
    std::map<std::uint32_t, KinectFrameJoiner> joiners{};  // by sensor id; most_sensors at most
    std::vector<JoinedKinectFrame> frames{};
    // whole frames; messages of sensors beyond most_sensors
    std::uint64_t whole = 0, further_sensors = 0;
    std::uint64_t late = 0;                 // frames of a session that a newer one has ended
    std::vector<KinectOverlap> overlaps{};  // found by frames of this sender
    std::vector<KinectPing> pings{};
    bool datagrams = false;
    std::string sender{};
  };
  struct Piece {
    std::span<const std::uint8_t> bytes;
    HostTime arrival;
  };
  /// One function for each protocol. Only a Kinect's uses `newest`.
  static void feed(Noitom& noitom, const Piece& piece, NewestKinectFrames& newest);
  static void feed(Xsens& xsens, const Piece& piece, NewestKinectFrames& newest);
  static void feed(Kinect& kinect, const Piece& piece, NewestKinectFrames& newest);
  static void count(Kinect& kinect, KinectFrame frame, NewestKinectFrames& newest);
  static SenderCounts counts(const Noitom& noitom);
  static SenderCounts counts(const Xsens& xsens);
  static SenderCounts counts(const Kinect& kinect);

  std::variant<std::monostate, Noitom, Xsens, Kinect> decoder_;
  std::uint64_t refused_ = 0;  // pieces that contain unreadable data
};

}  // namespace kinalign
