// SPDX-License-Identifier: Apache-2.0
// Simulates the program that sends a Kinect's frames live: the binary stream of
// docs/formats/kinect_stream.md over UDP. The program has another clock than the sensor.
#pragma once

#include "apps/kinalign/simulate/live_socket.h"

#include "kinalign/capture/net/host_clock.h"
#include "kinalign/protocols/kinect/message.h"
#include "kinalign/simulate/random.h"
#include "kinalign/simulate/rehearsal/rehearsal.h"

#include <optional>

namespace kinalign {

/// The settings of one run. `session` is new in each run, so that a host does not mix the run with
/// an earlier one.
struct LiveCameraOptions {
  std::uint64_t seed = 1;
  std::uint32_t session = 0;
  HostTime start{};       // the host's time at which the motion begins
  double length_s = 0.0;  // length of the motion, s
};

/// Sends frames at the sensor's ticks, a hello once a second and a ping five times a second. Hellos
/// and pings end with the motion. Invariant: frame_ is the first frame that has not been sent.
class LiveCamera {
 public:
  LiveCamera(const Rehearsal& rehearsal, const LiveCameraOptions& options, ClockReader& clock,
             LiveSocket socket);

  /// Receives pongs, and sends all frames, hellos and pings that are due.
  void work();
  /// The time at which the next frame, hello or ping is due.
  HostTime next() const;
  int fd() const { return socket_.fd(); }
  std::uint64_t sent() const { return sent_; }  // number of frames
  LiveTraffic traffic() { return socket_.traffic(); }
  /// The longest time by which this machine sent a frame too late.
  Duration worst_late() const { return worst_late_; }

 private:
  HostTime frame_due() const;
  void receive();
  void send_frame();
  void send_hello();
  void send_ping();
  bool send(const KinectMessage& message);
  KinectOrigin origin(std::uint32_t& sequence) const { return {1, session_, sequence++}; }
  // The time of the sender's clock in units of 100 ns, as messages have it.
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
