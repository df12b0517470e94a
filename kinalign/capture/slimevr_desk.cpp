// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/slimevr_desk.h"

#include <algorithm>

namespace kinalign {

namespace {

using Kind = SlimeEvent::Kind;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration left_after = seconds(1);  // as their server does
constexpr Duration replaced_after = seconds(60), told_again_after = seconds(10);
constexpr Duration heartbeat_every = milliseconds(500), ping_every = seconds(1);
constexpr std::uint64_t most_credit = 4096;
constexpr std::size_t most_sendings = 1024;  // of those that nobody takes
constexpr std::uint32_t handshake_type = 3, ping_type = 10;

}  // namespace

const char* name_of(SlimeVerdict verdict) {
  static constexpr std::array<const char*, slime_verdicts> names{
      "accepted", "duplicate", "late", "stranger", "limited", "elsewhere", "no_room", "too_short"};
  return names[static_cast<std::size_t>(verdict)];
}

const char* name_of(SlimeEvent::Kind kind) {
  static constexpr std::array<const char*, slime_event_kinds> names{
      "joined", "started", "moved", "left", "returned", "too_many"};
  return names[static_cast<std::size_t>(kind)];
}

SlimeDesk::SlimeDesk(const SipHashKey& secret) : secret_(secret), devices_(most_devices) {}

SlimeNews SlimeDesk::receive(const SlimeArrival& arrival) {
  SlimeNews news;
  samples_.clear();
  news.verdict = judge(arrival, news);
  ++counts_.verdicts[news.verdict];
  news.samples = samples_;
  return news;
}

SlimeVerdict SlimeDesk::judge(const SlimeArrival& arrival, SlimeNews& news) {
  if (!decode_slime(arrival.bytes, datagram_)) return SlimeVerdict::too_short;
  news.number = datagram_.number;
  // Of a bundle a handshake counts for nothing: trackers that have one are known already.
  const bool handshake = datagram_.type == handshake_type && !datagram_.packets.empty();
  if (handshake) {
    const auto& said = std::get<SlimeHandshake>(datagram_.packets.front());
    const SlimeVerdict verdict = shake_hands(said, arrival);
    if (verdict == SlimeVerdict::accepted) news.device = index(*device_at(arrival.from));
    return verdict;
  }
  SlimeDevice* device = find_device(arrival.from);
  if (device == nullptr) return SlimeVerdict::stranger;
  news.device = index(*device);
  hear(*device, arrival);
  if (datagram_.type != ping_type) {
    const Order order = device->numbers.push(datagram_.number);
    if (order == Order::duplicate) return SlimeVerdict::duplicate;
    if (order == Order::late) return SlimeVerdict::late;
  }
  counts_.unknown_type += datagram_.unknown_type;
  counts_.too_short += datagram_.too_short;
  counts_.nested += datagram_.nested;
  for (const SlimePacket& packet : datagram_.packets) take(*device, packet, arrival.h_rx);
  return SlimeVerdict::accepted;
}

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
  // Another device that was there before has another address now, or it is gone.
  SlimeDevice* other = find_device(arrival.from);
  if (other != nullptr && other != device) *other = {};
  if (!known) device = new_device(arrival.h_rx);
  if (device == nullptr) {
    if (arrival.h_rx >= tell_too_many_) {
      events_.add({Kind::too_many, 0, arrival.h_rx, arrival.from});
      tell_too_many_ = arrival.h_rx + told_again_after;
    }
    return SlimeVerdict::no_room;
  }
  device->used = true;
  device->mac = handshake.mac;
  device->address = arrival.from;
  device->protocol = handshake.protocol.value_or(0);
  device->firmware = handshake.firmware.value_or("");
  device->earlier += device->numbers.counts();
  device->numbers = SequenceCount(64);
  device->credit = 0;
  device->ping.reset();
  device->next_heartbeat = arrival.h_rx + heartbeat_every;
  device->next_ping = arrival.h_rx;
  ++device->handshakes;
  tell(!known ? Kind::joined : moves ? Kind::moved : Kind::started, *device, arrival.h_rx);
  device->silent = false;
  hear(*device, arrival);
  send(*device, slime_handshake_answer(arrival.bytes.size()));  // to one of 12 bytes none
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

SlimeDevice* SlimeDesk::device_named(const SlimeHandshake& handshake, const NodeAddress& address) {
  for (SlimeDevice& device : devices_) {
    if (!device.used || device.mac != handshake.mac) continue;
    if (handshake.mac || device.address == address) return &device;
  }
  return nullptr;
}

/// A free place, or that of the device which was silent for longest, if that was for a minute.
SlimeDevice* SlimeDesk::new_device(HostTime now) {
  const auto heard = [](const SlimeDevice& d) { return d.used ? d.heard : HostTime::min(); };
  SlimeDevice& place =
      *std::min_element(devices_.begin(), devices_.end(),
                        [&](const auto& a, const auto& b) { return heard(a) < heard(b); });
  if (place.used && now - place.heard <= replaced_after) return nullptr;
  place = {};
  return &place;
}

void SlimeDesk::hear(SlimeDevice& device, const SlimeArrival& arrival) {
  if (device.silent) tell(Kind::returned, device, arrival.h_rx);
  device.silent = false;
  device.heard = arrival.h_rx;
  device.credit = std::min(device.credit + arrival.bytes.size(), most_credit);
}

void SlimeDesk::take(SlimeDevice& device, const SlimePacket& packet, HostTime now) {
  if (const auto* motion = std::get_if<SlimeMotion>(&packet)) {
    take_motion(device, *motion);
  } else if (const auto* info = std::get_if<SlimeSensorInfo>(&packet)) {
    send(device, slime_sensor_info_acknowledged(info->sensor, info->status));
    if (info->sensor >= SlimeDevice::most_sensors) {
      ++counts_.no_sensor;
      return;
    }
    SlimeSensor& sensor = device.sensors[info->sensor];
    sensor.used = true;
    sensor.status = info->status;
    if (info->imu) sensor.imu = info->imu;
    if (info->position) sensor.position = info->position;
  } else if (std::holds_alternative<SlimeFeatures>(packet)) {
    send(device, slime_features());
  } else if (const auto* battery = std::get_if<SlimeBattery>(&packet)) {
    device.battery_volts = battery->volts;
    device.battery_level = battery->level;
  } else if (const auto* pong = std::get_if<SlimePing>(&packet)) {
    if (!device.ping || device.ping->id != pong->id) return;
    device.round_trip = now - device.ping->sent;
    device.ping.reset();
  }
}

void SlimeDesk::take_motion(SlimeDevice& device, const SlimeMotion& motion) {
  if (motion.is_correction) return;
  if (motion.sensor >= SlimeDevice::most_sensors) {
    ++counts_.no_sensor;
    return;
  }
  SlimeSample sample;
  sample.sensor = motion.sensor;
  if (motion.rotation) sample.orientation = slime_orientation(*motion.rotation);
  if (motion.acceleration) {
    sample.acceleration = slime_acceleration(*motion.acceleration, device.protocol);
  }
  if (motion.rotation && !sample.orientation) ++counts_.wild;
  if (motion.acceleration && !sample.acceleration) ++counts_.wild;
  if (!sample.orientation && !sample.acceleration) return;
  SlimeSensor& sensor = device.sensors[motion.sensor];
  sensor.used = true;
  ++sensor.samples;
  samples_.push_back(sample);
}

/// Never more bytes than came from there since its handshake.
void SlimeDesk::send(SlimeDevice& device, const SlimeAnswer& answer) {
  if (device.credit < answer.size || sendings_.size() >= most_sendings) {
    ++counts_.unsent;
    return;
  }
  device.credit -= answer.size;
  ++counts_.sent;
  sendings_.push_back({device.address, answer});
}

void SlimeDesk::ping(SlimeDevice& device, HostTime now) {
  device.next_ping = now + ping_every;
  std::array<std::uint8_t, 8> count{};
  for (std::size_t i = 0; i < count.size(); ++i) {
    count[i] = static_cast<std::uint8_t>(pings_ >> (8 * i));
  }
  ++pings_;
  device.ping = {static_cast<std::uint32_t>(siphash_2_4(secret_, count)), now};
  send(device, slime_ping(device.ping->id));
}

void SlimeDesk::tick(HostTime now) {
  for (SlimeDevice& device : devices_) {
    if (!device.used) continue;
    if (!device.silent && now - device.heard >= left_after) {
      device.silent = true;
      tell(Kind::left, device, now);
    }
    if (now >= device.next_heartbeat) {
      device.next_heartbeat = now + heartbeat_every;
      send(device, slime_heartbeat());
    }
    if (now >= device.next_ping) ping(device, now);
  }
}

std::span<const SlimeSending> SlimeDesk::take_sendings() {
  taken_.clear();
  std::swap(taken_, sendings_);
  return taken_;
}

std::size_t SlimeDesk::index(const SlimeDevice& device) const {
  return static_cast<std::size_t>(&device - devices_.data());
}

void SlimeDesk::tell(SlimeEvent::Kind kind, const SlimeDevice& device, HostTime at) {
  events_.add({kind, index(device), at, device.address});
}

}  // namespace kinalign
