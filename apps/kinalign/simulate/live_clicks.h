// SPDX-License-Identifier: Apache-2.0
// The clicks on a suit's program, live: each click is sent to the recorder as a mark, like from a
// program that controls the lab.
#pragma once

#include "apps/kinalign/simulate/live_socket.h"

#include "kinalign/protocols/marks/mark.h"
#include "kinalign/simulate/rehearsal/rehearsal.h"
#include "kinalign/wire/time.h"

#include <string>
#include <vector>

namespace kinalign {

/// Two clicks, each sent twice. Invariant: calls_[0] to calls_[sent_ - 1] were sent.
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
