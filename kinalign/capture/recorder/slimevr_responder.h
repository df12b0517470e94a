// SPDX-License-Identifier: Apache-2.0
// The host's side of SlimeVR trackers (docs/formats/slimevr.md). It judges each datagram, makes the
// answers and identifies the trackers. It uses no socket and no clock, and its memory is limited.
// The caller passes the time. Measurements are recorded as received and not decoded here.
#pragma once

#include "kinalign/capture/net/counts_by.h"
#include "kinalign/capture/net/rate_limit.h"
#include "kinalign/capture/nodes/node_session.h"
#include "kinalign/core/error.h"
#include "kinalign/protocols/sequence_count.h"
#include "kinalign/protocols/slimevr/packet.h"
#include "kinalign/wire/siphash.h"

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

struct SlimeArrival {
  std::span<const std::uint8_t> bytes;
  NodeAddress from;
  HostTime h_rx{};
};

enum class SlimeVerdict : std::uint8_t {
  accepted,
  duplicate,      // the datagram number was received before
  late,           // a datagram with a higher number arrived earlier
  unknown,        // this address has not sent a handshake
  limited,        // an unknown address sends handshakes too often
  duplicate_mac,  // a handshake with the MAC address of a device that sends from another address
  no_room,        // the table of devices is full
  too_short       // not a datagram of a tracker
};
inline constexpr std::size_t slime_verdicts = 8;
using SlimeVerdicts = CountsBy<SlimeVerdict, slime_verdicts>;
/// Number of useless datagrams: all except accepted, duplicate and late ones.
std::uint64_t refused(const SlimeVerdicts& verdicts);
/// Returns findings about an address with these verdicts. `name` appears in the messages.
Findings findings_of(const SlimeVerdicts& verdicts, const std::string& name);

/// The result of one datagram, for the counts of its address.
struct SlimeResult {
  SlimeVerdict verdict = SlimeVerdict::too_short;
  bool restarts_counts = false;  // the datagram was a handshake that was accepted
  bool has_packet = false;       // the datagram contains a tracker's packet, accepted or not
};

/// A datagram to send. The datagrams must be sent in order.
struct SlimeSending {
  NodeAddress to;
  SlimeAnswer answer;
};

struct SlimeDevice {
  bool used = false;
  std::optional<SlimeMac> mac;  // absent: the device is identified by its address
  NodeAddress address;
  std::optional<float> battery_volts;
  HostTime last_arrival = HostTime::min();
  SequenceCount numbers{64};  // numbers received since the newest handshake
  std::uint64_t credit = 0;   // bytes that may still be sent to this device
  HostTime next_heartbeat{}, next_ping{};
};

/// Responder of one port. Its decisions depend only on arguments, so tests need no tracker.
class SlimeResponder {
 public:
  static constexpr std::size_t most_devices = 64;

  /// `secret`: random in each run; used for ids of pings and for hashes of unknown senders.
  explicit SlimeResponder(const SipHashKey& secret);

  /// Judges one datagram. Call in the order of arrival.
  SlimeResult receive(const SlimeArrival& arrival);
  /// Call about ten times a second. Queues the heartbeats and pings that are due.
  void tick(HostTime now);
  /// Returns the datagrams to send since the previous call.
  std::vector<SlimeSending> take_sendings() { return std::exchange(sendings_, {}); }

  /// Returns nullptr if no device has this address.
  const SlimeDevice* device_at(const NodeAddress& address) const;

 private:
  /// Admits a device, or moves it to the address of its newest handshake.
  SlimeVerdict take_handshake(const SlimeHandshake& handshake, const SlimeArrival& arrival);
  SlimeDevice* find_device(const NodeAddress& address);
  SlimeDevice* device_named(const SlimeHandshake& handshake, const NodeAddress& address);
  SlimeDevice* new_device(HostTime now);
  static void note_datagram(SlimeDevice& device, const SlimeArrival& arrival);
  void take(SlimeDevice& device, const SlimePacket& packet);
  void send(SlimeDevice& device, const SlimeAnswer& answer);
  void ping(SlimeDevice& device, HostTime now);

  SipHashKey secret_;
  std::vector<SlimeDevice> devices_;
  RateLimit unknown_senders_;
  std::uint64_t pings_ = 0;
  std::vector<SlimeSending> sendings_;
  SlimeDatagram datagram_;
};

}  // namespace kinalign
