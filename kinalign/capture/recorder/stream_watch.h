// SPDX-License-Identifier: Apache-2.0
// Counts one sender's data during recording: frames, unreadable data, and lost, late and duplicate
// frames by the sender's own numbers. The recorded bytes do not depend on these counts.
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

/// The sessions of all Kinects of a port, by sensor id. A Kinect may use several senders in turn.
using NewestKinectFrames = std::map<std::uint32_t, KinectSessions>;

/// Decodes only what the counts need. The result does not change what is recorded.
class StreamWatch {
 public:
  /// A protocol that another class decodes is not counted here. `datagrams`: each piece is a
  /// datagram with whole messages; otherwise a message may continue in the next piece. `sender`:
  /// the sender's name in findings.
  explicit StreamWatch(Protocol protocol, bool datagrams = false, const std::string& sender = "");

  /// Decodes one piece. `newest`: the sessions of the port's Kinects. If a Kinect returns over a
  /// new connection, its count continues, or its restart is recognised.
  void feed(std::string_view piece, HostTime arrival, NewestKinectFrames& newest);
  /// The Kinect pings that ended in the last piece.
  std::span<const KinectPing> pings() const;
  /// Returns whether the sender uses the text form, one message per line. Pongs must have the same
  /// form.
  bool speaks_lines() const;
  /// Returns whether another sender uses the same sensor id at the same time.
  bool has_overlap() const;
  /// Counts of frames. The caller counts messages and bytes.
  SenderCounts counts() const;
  /// Findings about this sender. `name` appears in the messages.
  Findings findings(const std::string& name) const;

 private:
  /// The decoder of one sender; each protocol has one. The vectors are members, so that their
  /// memory is reused.
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
    // number of whole frames, and of messages from sensors beyond most_sensors
    std::uint64_t whole = 0, further_sensors = 0;
    std::uint64_t late = 0;                 // frames of a session that is over
    std::vector<KinectOverlap> overlaps{};  // found by frames of this sender
    std::vector<KinectPing> pings{};
    bool datagrams = false;
    std::string sender{};
  };
  struct Piece {
    std::span<const std::uint8_t> bytes;
    HostTime arrival;
  };
  /// One function for each protocol. Only the function for Kinects uses `newest`.
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
