// SPDX-License-Identifier: Apache-2.0
// The host's side of SlimeVR trackers (docs/formats/slimevr.md). It judges each datagram, makes the
// answers and identifies the trackers. It uses no socket and no clock, and its memory is fixed.
// Time is an argument. Measurements are not decoded here; they are recorded as received.
#pragma once

#include "kinalign/capture/net/counts_by.h"
#include "kinalign/capture/net/rate_limit.h"
#include "kinalign/capture/nodes/node_session.h"
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
  duplicate,  // its number was received before
  late,       // a newer one arrived before it
  stranger,   // no handshake came from this address
  limited,    // an unknown address that sends handshakes too often
  elsewhere,  // a handshake with the MAC of a device that sends from another address
  no_room,    // the table of devices is full
  too_short   // not a datagram of a tracker
};
inline constexpr std::size_t slime_verdicts = 8;
using SlimeVerdicts = CountsBy<SlimeVerdict, slime_verdicts>;
/// Datagrams that were useless: all except accepted, duplicate and late ones.
std::uint64_t refused(const SlimeVerdicts& verdicts);
/// Findings about an address with these verdicts. `name` appears in the messages.
Findings findings_of(const SlimeVerdicts& verdicts, const std::string& name);

/// The result of one datagram, for the counts of its address.
struct SlimeNews {
  SlimeVerdict verdict = SlimeVerdict::too_short;
  std::size_t device = 0;    // only if accepted
  bool counts_anew = false;  // the datagram was a handshake that was accepted
  bool spoke = false;        // the datagram contains a packet of a tracker; it need not be accepted
};

/// A datagram to send. The order must be kept.
struct SlimeSending {
  NodeAddress to;
  SlimeAnswer answer;
};

struct SlimeDevice {
  bool used = false;
  std::optional<SlimeMac> mac;  // absent: the device is identified by its address
  NodeAddress address;
  std::optional<float> battery_volts;
  HostTime heard{};
  SequenceCount numbers{64};  // since the newest handshake
  std::uint64_t credit = 0;   // bytes that may still be sent to this device
  HostTime next_heartbeat{}, next_ping{};
};

/// One for each port. Its decisions depend on arguments only, so tests need no tracker.
class SlimeDesk {
 public:
  static constexpr std::size_t most_devices = 64;

  /// `secret`: random in each run; ids of pings and the hash keys of unknown senders are made with
  /// it.
  explicit SlimeDesk(const SipHashKey& secret);

  /// Judges one datagram. Call in the order of arrival.
  SlimeNews receive(const SlimeArrival& arrival);
  /// Call about ten times a second. Sends heartbeats and pings.
  void tick(HostTime now);
  /// The datagrams to send since the previous call. Valid until the next call of this function.
  std::span<const SlimeSending> take_sendings();

  const SlimeDevice& device(std::size_t i) const { return devices_[i]; }
  /// nullptr: no device has this address.
  const SlimeDevice* device_at(const NodeAddress& address) const;

 private:
  SlimeVerdict judge(const SlimeArrival& arrival, SlimeNews& news);
  /// Admits a device, or moves it to the address of its newest handshake.
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
  /// Answers wait in `sendings_` until the port takes them; `taken_` holds those that it is
  /// sending.
  std::vector<SlimeSending> sendings_, taken_;
  SlimeDatagram datagram_;
};

}  // namespace kinalign
