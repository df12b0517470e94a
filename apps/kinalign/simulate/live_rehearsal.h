// SPDX-License-Identifier: Apache-2.0
// A rehearsal sent in real time over real sockets, as the devices would send it. In the app and in
// no room: it joins sockets, simulated devices and the firmware's own logic, and no room may know
// the last. One thread: some thousand events a second.
#pragma once

#include "apps/kinalign/simulate/live_camera.h"
#include "apps/kinalign/simulate/live_clicks.h"
#include "apps/kinalign/simulate/live_node.h"
#include "apps/kinalign/simulate/live_suit.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace kinalign {

struct LiveOptions {
  std::string to = "127.0.0.1";
  std::uint16_t mocap_port = 7012, kinect_port = 7020, node_port = 5005, marks_port = 7030;
  Link link = Link::paper;  // of the nodes
  std::uint64_t seed = 1;
  double begin_in_s = 0.5;
  bool clockless = false;  // nodes have no counter
};

struct LiveCounts {
  std::uint64_t mocap_frames = 0, kinect_frames = 0, node_frames = 0, node_samples = 0;
  std::uint64_t replies = 0;                         // of the host's to nodes that reached them
  LiveTraffic mocap{}, kinect{}, nodes{}, clicks{};  // on the host's port for each
  Duration worst_late{};                             // of a frame, by this machine

  LiveTraffic all() const;
};

/// A socket for each device, which has sent nothing yet.
struct LiveSockets {
  LiveSocket mocap, kinect, clicks;
  std::vector<LiveSocket> nodes;
};

/// `nodes`: how many. Fails as LiveSocket::connected_to.
Result<LiveSockets> open_live(const LiveOptions& options, std::size_t nodes);

/// Fails where Noitom's stream has no room for such a motion's skeleton; `name`: the motion's.
Result<void> check_live(const Motion& motion, const std::string& name);

class LiveRehearsal {
 public:
  /// Begins options.begin_in_s from now. `motion` and `rehearsal` have to stay.
  LiveRehearsal(const Motion& motion, const Rehearsal& rehearsal, const LiveOptions& options,
                ClockReader& clock, LiveSockets sockets);

  /// Time 0 of the motion, on both of the host's clocks.
  const ClockPair& start() const { return start_; }
  /// Until all is sent, and half a second more for what is on its way, or until `go_on` says no,
  /// which is asked at least ten times a second. How much of the motion was sent, s.
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

/// Stamps of the devices as they send them; times on the host's raw clock, brought to UTC by
/// `start`. Of nodes without a counter, of which there is a rate, a stamp is the number of the
/// request times the step.
TrueRecording live_truth(const Rehearsal& rehearsal, const Motion& motion, const ClockPair& start,
                         std::optional<double> clockless_hz);

}  // namespace kinalign
