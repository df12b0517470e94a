// SPDX-License-Identifier: Apache-2.0
// A Kinect's sender may split a frame into several parts (docs/formats/kinect_stream.md). This file
// joins the parts, counts losses, makes rows of joints, and makes time exchanges from pings and
// frames.
#pragma once

#include "kinalign/clock/host_from_node.h"
#include "kinalign/motion/streams.h"
#include "kinalign/protocols/kinect/message.h"
#include "kinalign/protocols/kinect/sessions.h"
#include "kinalign/protocols/sequence_count.h"

#include <map>

namespace kinalign {

/// A frame after joining. If a part is lost, its bodies are missing from the frame.
struct JoinedKinectFrame {
  KinectFrame frame;   // all parts that arrived; `sent_ticks` is that of the first part
  bool whole = false;  // no part is missing
};

/// Counts of one sensor. A frame without all its parts counts in `parts_lost` and not as a lost
/// frame.
struct KinectFrameCounts {
  SequenceCounts frames;  // all sessions; each session after the first counts as a restart
  std::uint64_t sessions = 0;
  std::uint64_t stale = 0;       // messages of an ended session, or with an outlier number
  std::uint64_t parts_lost = 0;  // frames that were not complete
  std::uint64_t parts_late = 0;  // parts that arrived after their frame was passed on
  std::uint64_t parts_doubled = 0;
  /// Parts that contradict the other parts of their frame. They are dropped.
  std::uint64_t contradicting = 0;

  bool operator==(const KinectFrameCounts&) const = default;
};

/// Joins the frames of one sensor, in the order of arrival. A restarted sender has a new session.
/// Within a session, a number that begins again counts as a restart only if the frame's ticks are
/// newer. Otherwise it counts as a duplicate.
class KinectFrameJoiner {
 public:
  /// Call this before the first frame if the sensor sent its previous frames over another
  /// connection. `last`: the last of those frames. Numbers missing after it count as lost, and a
  /// frame of another session counts as a restart.
  void follow(const KinectMoment& last);
  /// Adds a message. Appends to `out` each frame that is complete. If a new frame begins, the
  /// previous one is appended, too, without its missing parts. `sender`: the sender's address, for
  /// overlap().
  void take(KinectFrame message, std::vector<JoinedKinectFrame>& out, std::string_view sender = {});
  /// Call this at the end. It appends the open frame without its missing parts.
  void finish(std::vector<JoinedKinectFrame>& out);

  KinectFrameCounts counts() const;
  /// Two sessions that sent at the same time. Only frames of the newest session are joined.
  const std::optional<KinectOverlap>& overlap() const { return sessions_.overlap(); }

 private:
  /// Ends the counts of the previous session and starts new ones.
  void begin_session(std::uint32_t session);
  /// True if the message's ticks are newer than the ticks of all joined frames. Only such a message
  /// can be the first message after a restart of the sender.
  bool is_newer(const KinectFrame& message) const;
  void begin(KinectFrame message, std::vector<JoinedKinectFrame>& out);
  void join(KinectFrame message);
  void close(std::vector<JoinedKinectFrame>& out);
  /// The parts of one frame follow each other, so only one frame is open at a time. A part of
  /// another frame ends it.
  std::optional<KinectFrame> open_;
  std::uint32_t have_ = 0;            // received parts of the open frame, one bit each
  std::optional<std::uint8_t> last_;  // number of its last part; empty until that part has arrived
  KinectSessions sessions_;
  std::optional<std::uint32_t> session_;
  std::optional<KinectMoment> newest_;  // the frame with the newest ticks in this session
  SequenceCount sequence_{32};
  KinectFrameCounts counts_;
};

/// Appends a row, stamped with the device's ticks: the joints of body `body`. If the body isn't in
/// the frame, all 25 joints are missing. Joints that are not finite become missing, and the
/// function returns their number.
std::size_t append_kinect_row(const KinectFrame& frame, std::uint64_t body, PointFrames& out);

/// Converts ticks of 100 ns to a time on the sender's clock.
NodeTime kinect_sender_time(std::int64_t ticks);

/// The time exchange of a ping that arrived at `h_rx`. `h_tx`: the time at which the host sent the
/// pong that the ping echoes. The host keeps this time itself. `h_tx` is empty if the pong is
/// unknown.
Exchange exchange_of(const KinectPing& ping, HostTime h_rx, std::optional<HostTime> h_tx);
/// The exchange of a frame that arrived at `h_rx`. It has two times, so it bounds the sender's
/// clock from one side only.
Exchange exchange_of(const KinectFrame& frame, HostTime h_rx);

}  // namespace kinalign
