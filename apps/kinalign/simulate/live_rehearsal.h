// SPDX-License-Identifier: Apache-2.0
// A rehearsal in real time: simulated devices send their data over real sockets, as real devices
// would. The code is part of the program and not of the library, because it uses the firmware's
// code, which the library must not. One thread handles some thousand events a second.
#pragma once

#include "apps/kinalign/simulate/live_camera.h"
#include "apps/kinalign/simulate/live_node.h"
#include "apps/kinalign/simulate/live_suit.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace kinalign {

struct LiveOptions {
  std::string to = "127.0.0.1";
  std::int64_t mocap_port = 7012, kinect_port = 7020, node_port = 5005, marks_port = 7030;
  Link link = Link::paper;  // the simulated radio of the nodes
  std::uint64_t seed = 1;
  /// The time until the motion begins, s.
  double begin_in_s = 0.5;
  bool clockless = false;  // true: nodes have no counter
};

struct LiveCounts {
  std::uint64_t mocap_frames = 0, kinect_frames = 0, node_frames = 0, node_samples = 0;
  std::uint64_t replies = 0;                         // replies of the host that reached nodes
  LiveTraffic mocap{}, kinect{}, nodes{}, clicks{};  // datagrams, by the host's port
  Duration worst_late{};                             // the longest time by which a frame was late

  LiveTraffic all() const;
};

/// One socket for each device. They are opened before any file is made, so that a missing network
/// route leaves no files. Opening a socket sends nothing.
struct LiveSockets {
  LiveSocket mocap, kinect, clicks;
  std::vector<LiveSocket> nodes;
};

/// Opens the sockets. `nodes`: the number of nodes. Fails like LiveSocket::connected_to().
Result<LiveSockets> open_live(const LiveOptions& options, std::size_t nodes);

/// Fails if the motion's skeleton does not fit into Noitom's stream. `name`: the motion's name for
/// the error.
Result<void> check_live(const Motion& motion, const std::string& name);

/// Runs all simulated devices. Like real devices, they share only the motion and the host's clock.
/// The members are pointers, because a node can't be moved in memory: the firmware's code refers to
/// it.
class LiveRehearsal {
 public:
  /// The motion begins options.begin_in_s after this call. `motion` and `rehearsal` must live
  /// longer than this object.
  LiveRehearsal(const Motion& motion, const Rehearsal& rehearsal, const LiveOptions& options,
                ClockReader& clock, LiveSockets sockets);

  /// The time at which the motion begins, on the host's raw clock and in UTC.
  const ClockPair& start() const { return start_; }
  /// Sends everything, then waits half a second for datagrams that are still on their way. Calls
  /// `go_on` at least ten times a second and stops if it returns false. Returns the length of the
  /// motion that was sent, s.
  double run(const std::function<bool()>& go_on);
  LiveCounts counts() const;

 private:
  void wait(HostTime until) const;

  ClockReader* clock_;
  ClockPair start_;
  double length_s_;
  std::unique_ptr<LiveSuit> suit_;
  std::unique_ptr<LiveCamera> camera_;
  std::unique_ptr<LiveClicks> clicks_;
  std::vector<std::unique_ptr<LiveNode>> nodes_;
};

/// The truth of a live rehearsal, with stamps as the devices send them. Times are those of the
/// host's raw clock, converted to UTC with `start`. `clockless_hz`: the rate of nodes without a
/// counter; the stamp of such a node is the number of the request divided by the rate.
TrueRecording live_truth(const Rehearsal& rehearsal, const Motion& motion, const ClockPair& start,
                         std::optional<double> clockless_hz);

}  // namespace kinalign
