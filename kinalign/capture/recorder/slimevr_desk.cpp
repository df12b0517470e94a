// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/slimevr_desk.h"

#include <algorithm>

namespace kinalign {

namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration left_after = seconds(1);  // SlimeVR's own server does the same
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

/// A tracker that changes its address is admitted one second after its last datagram from the old
/// address.
Findings findings_of(const SlimeVerdicts& verdicts, const std::string& name) {
  constexpr std::uint64_t too_often = 3;  // a tracker that moves causes fewer
  constexpr const char* unanswered = "it is not answered, so it sends nothing of use";
  Findings findings;
  if (verdicts[SlimeVerdict::no_room] > 0) {
    findings.push_back(
        {Severity::warning,
         Error{name, 0, "at most " + std::to_string(SlimeDesk::most_devices) + " trackers",
               "one more"},
         unanswered, "switch others off: a minute later it has their place"});
  }
  if (verdicts[SlimeVerdict::elsewhere] >= too_often) {
    findings.push_back({Severity::warning,
                        Error{name, 0, "a tracker of its own", "the MAC of another one at work"},
                        unanswered, "see which two trackers have one MAC"});
  }
  return findings;
}

SlimeDesk::SlimeDesk(const SipHashKey& secret) : secret_(secret), devices_(most_devices) {}

SlimeNews SlimeDesk::receive(const SlimeArrival& arrival) {
  SlimeNews news;
  news.verdict = judge(arrival, news);
  return news;
}

SlimeVerdict SlimeDesk::judge(const SlimeArrival& arrival, SlimeNews& news) {
  if (!decode_slime(arrival.bytes, datagram_)) return SlimeVerdict::too_short;
  news.spoke = !datagram_.packets.empty();
  // A handshake inside a bundle is ignored: only trackers that are known already send bundles.
  const bool handshake = datagram_.type == handshake_type && !datagram_.packets.empty();
  if (handshake) {
    const auto& said = std::get<SlimeHandshake>(datagram_.packets.front());
    const SlimeVerdict verdict = shake_hands(said, arrival);
    news.counts_anew = verdict == SlimeVerdict::accepted;
    if (news.counts_anew) news.device = index(*device_at(arrival.from));
    return verdict;
  }
  SlimeDevice* device = find_device(arrival.from);
  if (device == nullptr) return SlimeVerdict::stranger;
  news.device = index(*device);
  hear(*device, arrival);
  // Returned pings have the host's number, so they say nothing about the order.
  if (datagram_.type != ping_type) {
    const Order order = device->numbers.push(datagram_.number);
    if (order == Order::duplicate) return SlimeVerdict::duplicate;
    if (order == Order::late) return SlimeVerdict::late;
  }
  for (const SlimePacket& packet : datagram_.packets) take(*device, packet);
  return SlimeVerdict::accepted;
}

// A tracker is identified by its MAC, or by its address if it sends no MAC.
SlimeVerdict SlimeDesk::shake_hands(const SlimeHandshake& handshake, const SlimeArrival& arrival) {
  SlimeDevice* device = device_named(handshake, arrival.from);
  const bool known = device != nullptr;
  const bool moves = known && device->address != arrival.from;
  if (moves && arrival.h_rx - device->heard < left_after) return SlimeVerdict::elsewhere;
  if (!known || moves) {
    const std::uint64_t hash = siphash_2_4(secret_, stranger(arrival.from.host));
    if (strangers_.ask(hash, arrival.h_rx) != RateLimit::Verdict::answer) {
      return SlimeVerdict::limited;
    }
  }
  // Another device that had this address has a new address, or it is gone.
  SlimeDevice* other = find_device(arrival.from);
  if (other != nullptr && other != device) *other = {};
  if (!known) device = new_device(arrival.h_rx);
  if (device == nullptr) return SlimeVerdict::no_room;
  device->used = true;
  device->mac = handshake.mac;
  device->address = arrival.from;
  device->numbers = SequenceCount(64);
  // The credit begins again: bytes from another address must not be answered here.
  device->credit = 0;
  device->next_heartbeat = arrival.h_rx + heartbeat_every;
  device->next_ping = arrival.h_rx;
  hear(*device, arrival);
  // a 12-byte handshake gets no answer
  send(*device, slime_handshake_answer(arrival.bytes.size()));
  return SlimeVerdict::accepted;
}

const SlimeDevice* SlimeDesk::device_at(const NodeAddress& address) const {
  for (const SlimeDevice& device : devices_) {
    if (device.used && device.address == address) return &device;
  }
  return nullptr;
}

SlimeDevice* SlimeDesk::find_device(const NodeAddress& address) {
  const SlimeDevice* found = device_at(address);
  return found == nullptr ? nullptr : &devices_[index(*found)];
}

// By MAC; a handshake without a MAC matches only a device without one at the same address.
SlimeDevice* SlimeDesk::device_named(const SlimeHandshake& handshake, const NodeAddress& address) {
  for (SlimeDevice& device : devices_) {
    if (!device.used || device.mac != handshake.mac) continue;
    if (handshake.mac || device.address == address) return &device;
  }
  return nullptr;
}

/// Returns a free place, or that of the device silent longest if it was silent for a minute.
SlimeDevice* SlimeDesk::new_device(HostTime now) {
  const auto heard = [](const SlimeDevice& d) { return d.used ? d.heard : HostTime::min(); };
  SlimeDevice& place =
      *std::min_element(devices_.begin(), devices_.end(),
                        [&](const auto& a, const auto& b) { return heard(a) < heard(b); });
  if (place.used && now - place.heard <= tracker_replaced_after) return nullptr;
  place = {};
  return &place;
}

void SlimeDesk::hear(SlimeDevice& device, const SlimeArrival& arrival) {
  device.heard = arrival.h_rx;
  device.credit = std::min(device.credit + arrival.bytes.size(), most_credit);
}

// Only packets that need an answer or are shown to the user. Measurements are recorded as they are.
void SlimeDesk::take(SlimeDevice& device, const SlimePacket& packet) {
  if (const auto* info = std::get_if<SlimeSensorInfo>(&packet)) {
    send(device, slime_sensor_info_acknowledged(info->sensor, info->status));
  } else if (std::holds_alternative<SlimeFeatures>(packet)) {
    send(device, slime_features());
  } else if (const auto* battery = std::get_if<SlimeBattery>(&packet)) {
    device.battery_volts = battery->volts;
  }
}

/// Sends at most as many bytes as arrived from that address since its handshake.
void SlimeDesk::send(SlimeDevice& device, const SlimeAnswer& answer) {
  if (device.credit < answer.size || sendings_.size() >= most_sendings) return;
  device.credit -= answer.size;
  sendings_.push_back({device.address, answer});
}

// Ids are hashed, so that a forger can't guess them.
void SlimeDesk::ping(SlimeDevice& device, HostTime now) {
  device.next_ping = now + ping_every;
  std::array<std::uint8_t, 8> count{};
  for (std::size_t i = 0; i < count.size(); ++i) {
    count[i] = static_cast<std::uint8_t>(pings_ >> (8 * i));
  }
  ++pings_;
  send(device, slime_ping(static_cast<std::uint32_t>(siphash_2_4(secret_, count))));
}

void SlimeDesk::tick(HostTime now) {
  for (SlimeDevice& device : devices_) {
    if (!device.used) continue;
    if (now >= device.next_heartbeat) {
      device.next_heartbeat = now + heartbeat_every;
      send(device, slime_heartbeat());
    }
    if (now >= device.next_ping) ping(device, now);
  }
}

std::span<const SlimeSending> SlimeDesk::take_sendings() {
  taken_.clear();
  // Both buffers keep their memory.
  std::swap(taken_, sendings_);
  return taken_;
}

std::size_t SlimeDesk::index(const SlimeDevice& device) const {
  return static_cast<std::size_t>(&device - devices_.data());
}

}  // namespace kinalign
