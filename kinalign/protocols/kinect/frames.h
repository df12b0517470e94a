// SPDX-License-Identifier: Apache-2.0
// A Kinect's frames as one goes on with them: parts joined, losses counted, rows of joints, and
// what a ping says of the sender's clock. docs/formats/kinect_stream.md.
#pragma once

#include "kinalign/clock/host_from_node.h"
#include "kinalign/motion/streams.h"
#include "kinalign/protocols/kinect/message.h"
#include "kinalign/protocols/kinect/sessions.h"
#include "kinalign/protocols/sequence_count.h"

#include <map>

namespace kinalign {

struct JoinedKinectFrame {
  KinectFrame frame;   // of all its parts; `sent_ticks` is the first one's
  bool whole = false;  // no part lacks
};

struct KinectFrameCounts {
  SequenceCounts frames;  // of all sessions so far; each but the first one is a restart, unless
                          // the one before it speaks on
  std::uint64_t sessions = 0;
  std::uint64_t stale = 0;       // messages of a session that is over, or numbered so
  std::uint64_t parts_lost = 0;  // frames that were not whole
  std::uint64_t parts_late = 0;  // came when their frame was handed on already
  std::uint64_t parts_doubled = 0;
  std::uint64_t contradicting = 0;  // parts that can't be of one frame: the later one is dropped

  bool operator==(const KinectFrameCounts&) const = default;
};

/// Frames of one sensor, in the order of arrival. Who is started anew has a new session; numbers
/// that begin anew within one are believed of frames with newer ticks alone, else they are sent
/// again.
class KinectFrameJoiner {
 public:
  /// Before the first frame: the sensor's last one came another way. What lacks behind it is lost;
  /// a frame of another session is a restart.
  void follow(const KinectMoment& last);
  /// The session that was followed speaks on: this sender's is no restart of it.
  void begin_beside() { ++begun_beside_; }
  /// Appends what is done: frames that are whole, and the one before if it never will be. `sender`:
  /// where it came from, for twins().
  void take(KinectFrame message, std::vector<JoinedKinectFrame>& out, std::string_view sender = {});
  /// What waits for its parts still.
  void finish(std::vector<JoinedKinectFrame>& out);

  KinectFrameCounts counts() const;
  /// Two senders that spoke by turns: frames of the later session alone are joined.
  const std::optional<KinectTwins>& twins() const { return sessions_.twins(); }

 private:
  void begin_session(std::uint32_t session);
  bool is_newer(const KinectFrame& message) const;
  void begin(KinectFrame message, std::vector<JoinedKinectFrame>& out);
  void join(KinectFrame message);
  void close(std::vector<JoinedKinectFrame>& out);
  std::optional<KinectFrame> open_;
  std::uint32_t have_ = 0;            // parts of the open frame, a bit each
  std::optional<std::uint8_t> last_;  // its last part
  KinectSessions sessions_;
  std::optional<std::uint32_t> session_;
  std::optional<KinectMoment> newest_;  // of its frames that were joined
  std::uint64_t begun_beside_ = 0;
  SequenceCount sequence_{32};
  KinectFrameCounts counts_;
};

/// Appends a row, stamped by the device's ticks: the body of this id, or where it isn't in the
/// frame 25 missing joints. Joints that are not finite are missing and their number is returned.
std::size_t append_kinect_row(const KinectFrame& frame, std::uint64_t body, PointFrames& out);

/// Ticks on the sender's clock.
NodeTime kinect_sender_time(std::int64_t ticks);

/// What a ping that arrived at `h_rx` says of the sender's clock. `h_tx`: when the pong was sent
/// that its echo names, of the host's own table; absent: it names none.
Exchange exchange_of(const KinectPing& ping, HostTime h_rx, std::optional<HostTime> h_tx);
/// A frame bounds that clock from one side.
Exchange exchange_of(const KinectFrame& frame, HostTime h_rx);

}  // namespace kinalign
