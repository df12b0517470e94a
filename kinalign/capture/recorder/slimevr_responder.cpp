// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/slimevr_responder.h"

#include <algorithm>

namespace kinalign {

namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration left_after = seconds(1);  // the same time as in SlimeVR's own server
constexpr Duration tracker_replaced_after = seconds(60);
constexpr Duration heartbeat_every = milliseconds(500), ping_every = seconds(1);
// Limit on the bytes that may be sent to a device without new data from it.
constexpr std::uint64_t most_credit = 4096;
constexpr std::size_t most_sendings = 1024;  // limit on messages that wait in sendings_
constexpr std::uint32_t handshake_type = 3, ping_type = 10;

}  // namespace

std::uint64_t refused(const SlimeVerdicts& verdicts) {
  using Verdict = SlimeVerdict;
  return verdicts.total() - verdicts[Verdict::accepted] - verdicts[Verdict::duplicate] -
         verdicts[Verdict::late];
}

/// Returns the faults that the refused datagrams of an address show.
Findings findings_of(const SlimeVerdicts& verdicts, const std::string& name) {
  constexpr std::uint64_t too_often = 3;  // a tracker that changes its address causes fewer
  constexpr const char* unanswered =
      "record does not answer this tracker, so the tracker sends no rotations";
  Findings findings;
  if (verdicts[SlimeVerdict::no_room] > 0) {
    findings.push_back(
        {Severity::warning,
         Error{name, 0, "at most " + std::to_string(SlimeResponder::most_devices) + " trackers",
               "another tracker"},
         unanswered, "switch another tracker off; its place is free after a minute"});
  }
  if (verdicts[SlimeVerdict::duplicate_mac] >= too_often) {
    findings.push_back(
        {Severity::warning,
         Error{name, 0, "a MAC address of its own", "the MAC address of another active tracker"},
         unanswered, "find the two trackers with this MAC address"});
  }
  return findings;
}

SlimeResponder::SlimeResponder(const SipHashKey& secret)
    : secret_(secret), devices_(most_devices) {}

SlimeResult SlimeResponder::receive(const SlimeArrival& arrival) {
  if (!decode_slime(arrival.bytes, datagram_)) return {};
  const bool has_packet = !datagram_.packets.empty();
  // A handshake inside a bundle is ignored, because only known trackers send bundles.
  if (datagram_.type == handshake_type && has_packet) {
    const SlimeVerdict verdict =
        take_handshake(std::get<SlimeHandshake>(datagram_.packets.front()), arrival);
    return {verdict, verdict == SlimeVerdict::accepted, has_packet};
  }
  SlimeDevice* device = find_device(arrival.from);
  if (device == nullptr) return {SlimeVerdict::unknown, false, has_packet};
  note_datagram(*device, arrival);
  // A returned ping has the number that the host sent, so its number tells nothing about the order.
  if (datagram_.type != ping_type) {
    const Order order = device->numbers.push(datagram_.number);
    if (order == Order::duplicate) return {SlimeVerdict::duplicate, false, has_packet};
    if (order == Order::late) return {SlimeVerdict::late, false, has_packet};
  }
  for (const SlimePacket& packet : datagram_.packets) take(*device, packet);
  return {SlimeVerdict::accepted, false, has_packet};
}

// The MAC address identifies a tracker. If it sends none, its network address identifies it.
SlimeVerdict SlimeResponder::take_handshake(const SlimeHandshake& handshake,
                                            const SlimeArrival& arrival) {
  SlimeDevice* device = device_named(handshake, arrival.from);
  const bool known = device != nullptr;
  const bool moves = known && device->address != arrival.from;
  // A tracker may change its address one second after its last datagram from the old address.
  if (moves && arrival.h_rx - device->last_arrival < left_after) return SlimeVerdict::duplicate_mac;
  if (!known || moves) {
    const std::uint64_t hash = siphash_2_4(secret_, address_prefix(arrival.from.host));
    if (unknown_senders_.ask(hash, arrival.h_rx) != RateLimit::Verdict::answer) {
      return SlimeVerdict::limited;
    }
  }
  // If another device had this address, that device has moved or is gone.
  SlimeDevice* other = find_device(arrival.from);
  if (other != nullptr && other != device) *other = {};
  if (!known) device = new_device(arrival.h_rx);
  if (device == nullptr) return SlimeVerdict::no_room;
  device->used = true;
  device->mac = handshake.mac;
  device->address = arrival.from;
  device->numbers = SequenceCount(64);
  // The credit begins at zero, because bytes from another address must not be answered here.
  device->credit = 0;
  device->next_heartbeat = arrival.h_rx + heartbeat_every;
  device->next_ping = arrival.h_rx;
  note_datagram(*device, arrival);
  // a handshake of only 12 bytes gets no answer
  send(*device, slime_handshake_answer(arrival.bytes.size()));
  return SlimeVerdict::accepted;
}

const SlimeDevice* SlimeResponder::device_at(const NodeAddress& address) const {
  for (const SlimeDevice& device : devices_) {
    if (device.used && device.address == address) return &device;
  }
  return nullptr;
}

SlimeDevice* SlimeResponder::find_device(const NodeAddress& address) {
  return const_cast<SlimeDevice*>(device_at(address));
}

// Finds the device by its MAC address. A handshake without MAC matches only a device without MAC at
// the same address.
SlimeDevice* SlimeResponder::device_named(const SlimeHandshake& handshake,
                                          const NodeAddress& address) {
  for (SlimeDevice& device : devices_) {
    if (!device.used || device.mac != handshake.mac) continue;
    if (handshake.mac || device.address == address) return &device;
  }
  return nullptr;
}

/// Returns a free place, or the place of the device silent longest if it was silent for a minute.
/// The last arrival of a free place is the earliest possible time.
SlimeDevice* SlimeResponder::new_device(HostTime now) {
  SlimeDevice& place = *std::min_element(
      devices_.begin(), devices_.end(),
      [](const auto& a, const auto& b) { return a.last_arrival < b.last_arrival; });
  if (place.used && now - place.last_arrival <= tracker_replaced_after) return nullptr;
  place = {};
  return &place;
}

void SlimeResponder::note_datagram(SlimeDevice& device, const SlimeArrival& arrival) {
  device.last_arrival = arrival.h_rx;
  device.credit = std::min(device.credit + arrival.bytes.size(), most_credit);
}

// Handles only packets that need an answer or are displayed. Measurements are recorded as received.
void SlimeResponder::take(SlimeDevice& device, const SlimePacket& packet) {
  if (const auto* info = std::get_if<SlimeSensorInfo>(&packet)) {
    send(device, slime_sensor_info_acknowledged(info->sensor, info->status));
  } else if (std::holds_alternative<SlimeFeatures>(packet)) {
    send(device, slime_features());
  } else if (const auto* battery = std::get_if<SlimeBattery>(&packet)) {
    device.battery_volts = battery->volts;
  }
}

/// Sends at most as many bytes as arrived from this address since its handshake.
void SlimeResponder::send(SlimeDevice& device, const SlimeAnswer& answer) {
  if (device.credit < answer.size || sendings_.size() >= most_sendings) return;
  device.credit -= answer.size;
  sendings_.push_back({device.address, answer});
}

// The id of a ping is hashed, so that a forger can't guess it.
void SlimeResponder::ping(SlimeDevice& device, HostTime now) {
  device.next_ping = now + ping_every;
  std::array<std::uint8_t, 8> count{};
  for (std::size_t i = 0; i < count.size(); ++i) {
    count[i] = static_cast<std::uint8_t>(pings_ >> (8 * i));
  }
  ++pings_;
  send(device, slime_ping(static_cast<std::uint32_t>(siphash_2_4(secret_, count))));
}

void SlimeResponder::tick(HostTime now) {
  for (SlimeDevice& device : devices_) {
    if (!device.used) continue;
    if (now >= device.next_heartbeat) {
      device.next_heartbeat = now + heartbeat_every;
      send(device, slime_heartbeat());
    }
    if (now >= device.next_ping) ping(device, now);
  }
}

}  // namespace kinalign
