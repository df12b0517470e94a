// SPDX-License-Identifier: Apache-2.0
// The program of a suit that broadcasts live: Noitom's binary stream with displacement, over UDP,
// and the clicks on this program.
#pragma once

#include "apps/kinalign/simulate/live_socket.h"

#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/protocols/marks/mark.h"
#include "kinalign/simulate/random.h"
#include "kinalign/simulate/rehearsal/rehearsal.h"

#include <string>
#include <vector>

namespace kinalign {

/// The delay, s, of a device's own program from the measurement to the socket: 2 ms, plus an
/// exponential part of 1 ms in the mean. These are low estimates: the host can't see the delay, and
/// real programs take longer.
inline double program_delay_s(const RandomStream& random, std::uint64_t frame) {
  return 0.002 + random.exponential(frame, 0, 0.001);
}

/// It knows no clock but the host's: the stream has no stamps, only frame numbers.
class LiveSuit {
 public:
  LiveSuit(const Motion& motion, const MocapRun& run, std::uint64_t seed, HostTime start,
           LiveSocket socket);

  /// Sends the frames that are due.
  void work(HostTime now);
  HostTime next() const { return next_; }
  std::uint64_t sent() const { return sent_; }
  LiveTraffic traffic() { return socket_.traffic(); }
  /// The longest delay of a frame by this machine.
  Duration worst_late() const { return worst_late_; }

 private:
  void plan();
  std::vector<std::uint8_t> datagram();

  const Motion& motion_;
  MocapRun run_;
  RandomStream random_;
  HostTime start_;
  LiveSocket socket_;
  BvhChannels channels_;
  Pose pose_;
  std::size_t frame_ = 0;
  HostTime next_ = HostTime::max();
  std::uint64_t sent_ = 0;
  Duration worst_late_{0};
};

/// The clicks on the suit's program. Each is sent to the recorder as a mark, twice, like from a
/// program that controls the lab. Invariant: calls_[0] to calls_[sent_ - 1] were sent.
class LiveClicks {
 public:
  /// `run`: differs in each run, so that its marks are not taken for repeats of an earlier run's.
  LiveClicks(const MocapRun& mocap, std::uint64_t run, HostTime start, LiveSocket socket);

  /// Sends the calls that are due, and takes the answers, which are only counted.
  void work(HostTime now);
  LiveTraffic traffic() { return socket_.traffic(); }
  HostTime next() const { return sent_ < calls_.size() ? calls_[sent_].at : HostTime::max(); }

 private:
  struct Call {
    HostTime at{};
    std::string text;
  };
  void add(Mark::Kind kind, const std::string& id, HostTime at);

  LiveSocket socket_;
  std::vector<Call> calls_;  // in the order of their times
  std::size_t sent_ = 0;
};

}  // namespace kinalign
