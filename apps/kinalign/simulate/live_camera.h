// SPDX-License-Identifier: Apache-2.0
// The sender of a Kinect, live: docs/formats/kinect_stream.md, binary, over UDP. It has a clock of
// its own besides the sensor's.
#pragma once

#include "apps/kinalign/simulate/live_socket.h"

#include "kinalign/capture/net/host_clock.h"
#include "kinalign/protocols/kinect/message.h"
#include "kinalign/simulate/random.h"
#include "kinalign/simulate/rehearsal/rehearsal.h"

#include <optional>

namespace kinalign {

/// `session` is new in each run, so a host does not mix this run with an earlier one.
struct LiveCameraOptions {
  std::uint64_t seed = 1;
  std::uint32_t session = 0;
  HostTime start{};       // time 0 of the motion
  double length_s = 0.0;  // the motion's, s
};

/// Three schedules run side by side: frames by the sensor's ticks, hellos once a second, pings five
/// times a second. Hellos and pings end with the motion. Invariant: frame_ is the next frame that
/// was not sent.
class LiveCamera {
 public:
  LiveCamera(const Rehearsal& rehearsal, const LiveCameraOptions& options, ClockReader& clock,
             LiveSocket socket);

  /// Takes pongs, and sends the frames, hellos and pings that are due.
  void work();
  /// The time of the next frame, hello or ping.
  HostTime next() const;
  int fd() const { return socket_.fd(); }
  std::uint64_t sent() const { return sent_; }  // frames
  LiveTraffic traffic() { return socket_.traffic(); }
  /// The longest delay of a frame by this machine.
  Duration worst_late() const { return worst_late_; }

 private:
  HostTime frame_due() const;
  void receive();
  void send_frame();
  void send_hello();
  void send_ping();
  bool send(const KinectMessage& message);
  KinectOrigin origin(std::uint32_t& sequence) const { return {1, session_, sequence++}; }
  // The program's clock in units of 100 ns, as it stands in messages.
  std::int64_t sender_ticks(HostTime t) const;

  const Rehearsal& rehearsal_;
  ClockReader& clock_;
  RandomStream random_;
  SimulatedClock sender_;
  HostTime start_, next_hello_, next_ping_, end_;
  std::uint32_t session_;
  LiveSocket socket_;
  std::size_t frame_ = 0;
  std::uint32_t hellos_ = 0, pings_ = 0;
  std::optional<KinectEcho> echo_;
  std::uint64_t sent_ = 0;
  Duration worst_late_{0};
};

}  // namespace kinalign
