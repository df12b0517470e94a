// SPDX-License-Identifier: Apache-2.0
// SlimeVR's trackers on the host's side (docs/formats/slimevr.md): what becomes of each datagram,
// what is sent, who is who. No socket, no clock and no growth: time is an argument. What a tracker
// measures is no matter here: it is recorded as it came.
#pragma once

#include "kinalign/capture/net/counts_by.h"
#include "kinalign/capture/net/rate_limit.h"
#include "kinalign/capture/nodes/node_life.h"
#include "kinalign/core/error.h"
#include "kinalign/protocols/sequence_count.h"
#include "kinalign/protocols/slimevr/packet.h"
#include "kinalign/wire/siphash.h"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

struct SlimeArrival {
  std::span<const std::uint8_t> bytes;
  NodeAddress from;
  HostTime h_rx{};
};

enum class SlimeVerdict : std::uint8_t {
  accepted,
  duplicate,  // its number was seen
  late,       // overtaken by a newer one
  stranger,   // no handshake came from there
  limited,    // a stranger's address that shakes hands too often
  elsewhere,  // a handshake in the name of a device that is heard from another address
  no_room,    // more devices than are kept
  too_short   // no datagram of a tracker
};
inline constexpr std::size_t slime_verdicts = 8;
using SlimeVerdicts = CountsBy<SlimeVerdict, slime_verdicts>;
/// Of them those of datagrams that were of no use.
std::uint64_t refused(const SlimeVerdicts& verdicts);
/// What the user should know of an address with these; `name` stands in the messages.
Findings findings_of(const SlimeVerdicts& verdicts, const std::string& name);

struct SlimeNews {
  SlimeVerdict verdict = SlimeVerdict::too_short;
  std::size_t device = 0;    // if accepted
  bool counts_anew = false;  // it shook hands
  bool spoke = false;        // as trackers do, let in or not
};

/// To be sent, in this order.
struct SlimeSending {
  NodeAddress to;
  SlimeAnswer answer;
};

struct SlimeDevice {
  bool used = false;
  std::optional<SlimeMac> mac;  // absent: the address is its name
  NodeAddress address;
  std::optional<float> battery_volts;
  HostTime heard{};
  SequenceCount numbers{64};  // since the newest handshake
  std::uint64_t credit = 0;   // bytes that may still be sent there
  HostTime next_heartbeat{}, next_ping{};
};

class SlimeDesk {
 public:
  static constexpr std::size_t most_devices = 64;

  /// `secret`: random in each run; the ids of pings and the strangers' table come from it.
  explicit SlimeDesk(const SipHashKey& secret);

  /// In the order of arrival.
  SlimeNews receive(const SlimeArrival& arrival);
  /// Ten times a second or so: heartbeats and pings.
  void tick(HostTime now);
  /// What the calls since brought about; good until the next one of them.
  std::span<const SlimeSending> take_sendings();

  const SlimeDevice& device(std::size_t i) const { return devices_[i]; }
  /// nullptr: none.
  const SlimeDevice* device_at(const NodeAddress& address) const;

 private:
  SlimeVerdict judge(const SlimeArrival& arrival, SlimeNews& news);
  SlimeVerdict shake_hands(const SlimeHandshake& handshake, const SlimeArrival& arrival);
  SlimeDevice* find_device(const NodeAddress& address);
  SlimeDevice* device_named(const SlimeHandshake& handshake, const NodeAddress& address);
  SlimeDevice* new_device(HostTime now);
  static void hear(SlimeDevice& device, const SlimeArrival& arrival);
  void take(SlimeDevice& device, const SlimePacket& packet);
  void send(SlimeDevice& device, const SlimeAnswer& answer);
  void ping(SlimeDevice& device, HostTime now);
  std::size_t index(const SlimeDevice& device) const;

  SipHashKey secret_;
  std::vector<SlimeDevice> devices_;
  RateLimit strangers_;
  std::uint64_t pings_ = 0;
  std::vector<SlimeSending> sendings_, taken_;
  SlimeDatagram datagram_;
};

}  // namespace kinalign
