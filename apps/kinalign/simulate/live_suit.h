// SPDX-License-Identifier: Apache-2.0
// Simulates the program of a motion capture suit that broadcasts live: Noitom's binary stream with
// positions, over UDP. Also simulates the user's clicks in this program.
#pragma once

#include "apps/kinalign/simulate/live_socket.h"

#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/protocols/marks/mark.h"
#include "kinalign/simulate/random.h"
#include "kinalign/simulate/rehearsal/rehearsal.h"

#include <string>
#include <vector>

namespace kinalign {

/// The delay, s, from a measurement to the sending of its frame in a device's program: 2 ms plus an
/// exponential part with mean 1 ms. Real programs probably take longer; the host can't measure the
/// delay.
inline double program_delay_s(const RandomStream& random, std::uint64_t frame) {
  return 0.002 + random.exponential(frame, 0, 0.001);
}

/// A suit that sends live. Its stream has only frame numbers and no stamps, so it needs no clock
/// other than the host's.
class LiveSuit {
 public:
  LiveSuit(const Motion& motion, const MocapRun& run, std::uint64_t seed, HostTime start,
           LiveSocket socket);

  /// Sends all frames that are due.
  void work(HostTime now);
  HostTime next() const { return next_; }
  std::uint64_t sent() const { return sent_; }
  LiveTraffic traffic() { return socket_.traffic(); }
  /// The longest time by which this machine sent a frame too late.
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

/// The user's clicks in the suit's program. Each click is sent to the recorder as a mark, in two
/// datagrams, as a program that controls the lab would send it. Invariant: calls_[0] to
/// calls_[sent_ - 1] have been sent.
class LiveClicks {
 public:
  /// `run`: a number that differs in each run, so that the recorder does not take the marks for
  /// repeats of an earlier run.
  LiveClicks(const MocapRun& mocap, std::uint64_t run, HostTime start, LiveSocket socket);

  /// Sends the marks that are due. Answers are received and only counted.
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
  std::vector<Call> calls_;  // sorted by time
  std::size_t sent_ = 0;
};

}  // namespace kinalign
