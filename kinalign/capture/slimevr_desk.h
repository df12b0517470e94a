// SPDX-License-Identifier: Apache-2.0
// SlimeVR's trackers on the host's side (docs/formats/slimevr.md): what becomes of each datagram,
// what is sent, who is who. No socket, no clock and no growth: time is an argument. Their packets
// carry no time, so a sample has an arrival and nothing better.
#pragma once

#include "kinalign/capture/counts_by.h"
#include "kinalign/capture/event_queue.h"
#include "kinalign/capture/node_life.h"
#include "kinalign/capture/rate_limit.h"
#include "kinalign/io/sequence_count.h"
#include "kinalign/io/slimevr_packet.h"
#include "kinalign/wire/siphash.h"

#include <array>
#include <optional>
#include <span>
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

/// As in --json: "too_short".
const char* name_of(SlimeVerdict verdict);

/// One reading of one sensor, which arrived with its datagram.
struct SlimeSample {
  std::uint8_t sensor = 0;
  std::optional<std::array<double, 4>> orientation;   // w,x,y,z, world (y up) from sensor
  std::optional<std::array<double, 3>> acceleration;  // m/s2, sensor's space, without gravity
};

struct SlimeNews {
  SlimeVerdict verdict = SlimeVerdict::too_short;
  std::size_t device = 0;                // if accepted
  std::uint64_t number = 0;              // of the packet
  std::span<const SlimeSample> samples;  // good until the next datagram
};

/// To be sent, in this order.
struct SlimeSending {
  NodeAddress to;
  SlimeAnswer answer;
};

struct SlimeSensor {
  bool used = false;
  std::uint8_t status = 0;
  std::optional<std::uint8_t> imu, position;
  std::uint64_t samples = 0;
};

struct SlimeDevice {
  static constexpr std::size_t most_sensors = 32;

  bool used = false;
  std::optional<SlimeMac> mac;  // absent: the address is its name
  NodeAddress address;
  std::int32_t protocol = 0;
  std::string firmware;
  std::array<SlimeSensor, most_sensors> sensors{};
  std::optional<float> battery_volts, battery_level;
  std::optional<Duration> round_trip;  // of the newest ping that came back
  HostTime heard{};
  bool silent = false;
  std::uint64_t handshakes = 0;
  SequenceCounts earlier;  // before the newest handshake
  SequenceCount numbers{64};
  std::uint64_t credit = 0;  // bytes that may still be sent there
  HostTime next_heartbeat{}, next_ping{};
  struct Ping {
    std::uint32_t id = 0;
    HostTime sent{};
  };
  std::optional<Ping> ping;  // that has not come back

  SequenceCounts counts() const {
    SequenceCounts sum = earlier;
    return sum += numbers.counts();
  }
};

struct SlimeEvent {
  enum class Kind : std::uint8_t {
    joined,    // a device
    started,   // another handshake of a known one
    moved,     // likewise, from another address
    left,      // nothing for a second
    returned,  // a datagram since
    too_many   // warning: a device was not taken in
  };
  Kind kind{};
  std::size_t device = 0;
  HostTime at{};
  NodeAddress address;
};
inline constexpr std::size_t slime_event_kinds = 6;

const char* name_of(SlimeEvent::Kind kind);

struct SlimeCounts {
  CountsBy<SlimeVerdict, slime_verdicts> verdicts;            // each datagram once
  std::uint64_t unknown_type = 0, too_short = 0, nested = 0;  // packets, in what is accepted
  std::uint64_t wild = 0;       // rotations and accelerations that are none
  std::uint64_t no_sensor = 0;  // of sensors above 31
  std::uint64_t unsent = 0;     // what would have been more bytes than came
  std::uint64_t sent = 0;
};

class SlimeDesk {
 public:
  static constexpr std::size_t most_devices = 64;

  /// `secret`: random in each run; the ids of pings and the strangers' table come from it.
  explicit SlimeDesk(const SipHashKey& secret);

  /// In the order of arrival.
  SlimeNews receive(const SlimeArrival& arrival);
  /// Ten times a second or so: heartbeats, pings, and who has left.
  void tick(HostTime now);
  /// What the calls since brought about; good until the next one of them.
  std::span<const SlimeSending> take_sendings();

  const SlimeDevice& device(std::size_t i) const { return devices_[i]; }
  /// nullptr: none.
  const SlimeDevice* device_at(const NodeAddress& address) const;
  const SlimeCounts& counts() const { return counts_; }
  std::vector<SlimeEvent> take_events() { return events_.take(); }
  std::uint64_t missed_events() const { return events_.missed(); }

 private:
  SlimeVerdict judge(const SlimeArrival& arrival, SlimeNews& news);
  SlimeVerdict shake_hands(const SlimeHandshake& handshake, const SlimeArrival& arrival);
  SlimeDevice* find_device(const NodeAddress& address);
  SlimeDevice* device_named(const SlimeHandshake& handshake, const NodeAddress& address);
  SlimeDevice* new_device(HostTime now);
  void hear(SlimeDevice& device, const SlimeArrival& arrival);
  void take(SlimeDevice& device, const SlimePacket& packet, HostTime now);
  void take_motion(SlimeDevice& device, const SlimeMotion& motion);
  void send(SlimeDevice& device, const SlimeAnswer& answer);
  void ping(SlimeDevice& device, HostTime now);
  std::size_t index(const SlimeDevice& device) const;
  void tell(SlimeEvent::Kind kind, const SlimeDevice& device, HostTime at);

  SipHashKey secret_;
  std::vector<SlimeDevice> devices_;
  RateLimit strangers_;
  SlimeCounts counts_;
  EventQueue<SlimeEvent> events_;
  HostTime tell_too_many_ = HostTime::min();  // not sooner
  std::uint64_t pings_ = 0;
  std::vector<SlimeSending> sendings_, taken_;
  std::vector<SlimeSample> samples_;  // of the datagram before
  SlimeDatagram datagram_;
};

}  // namespace kinalign
