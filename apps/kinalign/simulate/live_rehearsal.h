// SPDX-License-Identifier: Apache-2.0
// A rehearsal sent in real time over real sockets, as the devices would send it. It belongs to the
// app and to no room, since it joins sockets, simulated devices and the firmware's logic, and no
// room may use the firmware. One thread handles some thousand events a second.
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
  Link link = Link::paper;  // the nodes' radio
  std::uint64_t seed = 1;
  /// Time until the motion begins, s.
  double begin_in_s = 0.5;
  bool clockless = false;  // nodes have no counter
};

struct LiveCounts {
  std::uint64_t mocap_frames = 0, kinect_frames = 0, node_frames = 0, node_samples = 0;
  std::uint64_t replies = 0;                         // the host's replies that reached nodes
  LiveTraffic mocap{}, kinect{}, nodes{}, clicks{};  // by the host's port
  Duration worst_late{};                             // the longest delay of a frame by this machine

  LiveTraffic all() const;
};

/// A socket for each device. Opening it sends nothing.
/// The sockets are opened before any file is made, so that a missing route is found first.
struct LiveSockets {
  LiveSocket mocap, kinect, clicks;
  std::vector<LiveSocket> nodes;
};

/// `nodes`: the number of nodes. Fails like LiveSocket::connected_to.
Result<LiveSockets> open_live(const LiveOptions& options, std::size_t nodes);

/// Fails if the motion's skeleton does not fit Noitom's stream. `name`: the motion's name, for the
/// error.
Result<void> check_live(const Motion& motion, const std::string& name);

/// The devices share nothing but the motion and the clock, as real ones would. Pointers, because a
/// node can't be moved: its logic refers to it.
class LiveRehearsal {
 public:
  /// Begins options.begin_in_s from now. `motion` and `rehearsal` must live longer.
  LiveRehearsal(const Motion& motion, const Rehearsal& rehearsal, const LiveOptions& options,
                ClockReader& clock, LiveSockets sockets);

  /// Time 0 of the motion, on both of the host's clocks.
  const ClockPair& start() const { return start_; }
  /// Runs until all is sent, and half a second longer for datagrams on their way, or until `go_on`
  /// returns false, which is called at least ten times a second. Returns the part of the motion
  /// that was sent, s.
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

/// The truth with stamps as the devices send them. Times are on the host's raw clock, brought to
/// UTC by `start`. `clockless_hz`: the rate of nodes without a counter; their stamp is the number
/// of the request times the step.
TrueRecording live_truth(const Rehearsal& rehearsal, const Motion& motion, const ClockPair& start,
                         std::optional<double> clockless_hz);

}  // namespace kinalign
