// SPDX-License-Identifier: Apache-2.0
// Joins the parts of a Kinect's frames, counts losses, makes rows of joints, and makes time
// exchanges from pings and frames. docs/formats/kinect_stream.md.
#pragma once

#include "kinalign/clock/host_from_node.h"
#include "kinalign/motion/streams.h"
#include "kinalign/protocols/kinect/message.h"
#include "kinalign/protocols/kinect/sessions.h"
#include "kinalign/protocols/sequence_count.h"

#include <map>

namespace kinalign {

/// A frame as it is passed on. A lost part takes its bodies with it, but not the frame.
struct JoinedKinectFrame {
  KinectFrame frame;   // with all its parts; `sent_ticks` is that of the first part
  bool whole = false;  // no part is missing
};

/// Counts of one sensor. A frame that lost a part is not lost; it counts in `parts_lost`.
struct KinectFrameCounts {
  SequenceCounts frames;  // all sessions; each session but the first counts as a restart
  std::uint64_t sessions = 0;
  std::uint64_t stale = 0;       // messages of an ended session, or with a number of one
  std::uint64_t parts_lost = 0;  // frames that were not complete
  std::uint64_t parts_late = 0;  // parts that arrived after their frame was passed on
  std::uint64_t parts_doubled = 0;
  /// Parts that can't belong to the same frame; the later one is dropped.
  std::uint64_t contradicting = 0;

  bool operator==(const KinectFrameCounts&) const = default;
};

/// Joins the frames of one sensor, in the order of arrival. A sender that is restarted has a new
/// session. If the numbers restart within a session, that counts as a restart only for frames with
/// newer ticks; others count as repeats.
class KinectFrameJoiner {
 public:
  /// Call before the first frame if the sensor's last frame came over another connection. Numbers
  /// missing after it are lost; a frame of another session is a restart.
  void follow(const KinectMoment& last);
  /// Adds a message. Appends finished frames to `out`: complete ones, and the previous one if it
  /// can't be completed any more. `sender`: its address, for overlap().
  void take(KinectFrame message, std::vector<JoinedKinectFrame>& out, std::string_view sender = {});
  /// Call at the end: appends the frame whose parts are not complete.
  void finish(std::vector<JoinedKinectFrame>& out);

  KinectFrameCounts counts() const;
  /// Two sessions at the same time; only frames of the newest one are joined.
  const std::optional<KinectOverlap>& overlap() const { return sessions_.overlap(); }

 private:
  /// Ends the counts of the previous session and starts new ones.
  void begin_session(std::uint32_t session);
  /// True if the message's ticks are newer than those of all joined frames.
  /// Such a message may be the first after a restart of the sender.
  bool is_newer(const KinectFrame& message) const;
  void begin(KinectFrame message, std::vector<JoinedKinectFrame>& out);
  void join(KinectFrame message);
  void close(std::vector<JoinedKinectFrame>& out);
  /// The joiner holds one open frame at a time, because parts of one frame follow each other. A
  /// part of another frame ends it.
  std::optional<KinectFrame> open_;
  std::uint32_t have_ = 0;            // received parts of the open frame, one bit each
  std::optional<std::uint8_t> last_;  // number of its last part, once that has arrived
  KinectSessions sessions_;
  std::optional<std::uint32_t> session_;
  std::optional<KinectMoment> newest_;  // newest frame of the session that was joined
  SequenceCount sequence_{32};
  KinectFrameCounts counts_;
};

/// Appends a row, stamped with the device's ticks: the joints of body `body`, or 25 missing joints
/// if it isn't in the frame. Joints that are not finite become missing; returns their number.
std::size_t append_kinect_row(const KinectFrame& frame, std::uint64_t body, PointFrames& out);

/// Time on the sender's clock.
NodeTime kinect_sender_time(std::int64_t ticks);

/// The time exchange of a ping that arrived at `h_rx`. `h_tx`: the time at which the host sent the
/// pong that the ping echoes, from the host's own table; absent: no known pong.
Exchange exchange_of(const KinectPing& ping, HostTime h_rx, std::optional<HostTime> h_tx);
/// The exchange of a frame: it bounds the sender's clock from one side.
Exchange exchange_of(const KinectFrame& frame, HostTime h_rx);

}  // namespace kinalign
