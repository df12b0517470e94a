// SPDX-License-Identifier: Apache-2.0
// Random numbers (random.h): streams of a seed: 3 the properties of the link, 10 to 12 delays, 20
// and 21 good and bad states, 30 changes of route, 40 to 42 reordering and duplicates, 50 bursts,
// 60 to 62 losses of faults.
#include "kinalign/simulate/nodes/link.h"

#include "kinalign/simulate/random.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr double ms = 1e-3;
constexpr double queue_gap_s = 20e-6;

std::uint64_t number(Way way) { return static_cast<std::uint64_t>(way); }

struct Shares {
  double lost, duplicated, reordered;
};

/// Returns the shares of packets that each link loses, duplicates and reorders.
Shares shares(Link link) {
  switch (link) {
    case Link::wired:
      return {1e-5, 0.0, 0.0};
    case Link::quiet:
      return {0.005, 0.0005, 0.001};
    case Link::paper:
    case Link::thin_floor:
      return {0.02, 0.001, 0.002};
    case Link::modem_sleep:
      return {0.01, 0.001, 0.001};
    case Link::congested:
      return {0.03, 0.005, 0.01};
    case Link::roaming:
      return {0.01, 0.002, 0.005};
  }
  return {};
}

/// Two alternating states with exponential durations, beginning with the good state. Used for the
/// congested link and for bursts of loss.
class Dwells {
 public:
  Dwells(RandomStream random, double good_s, double bad_s)
      : random_(random), good_s_(good_s), bad_s_(bad_s) {}

  /// Returns whether the state at t is bad. Call with rising times.
  bool bad(double t) {
    while (end_ <= t) {
      end_ += random_.exponential(dwell_, 0, dwell_ % 2 == 0 ? good_s_ : bad_s_);
      ++dwell_;
    }
    return dwell_ % 2 == 0;
  }

 private:
  RandomStream random_;
  double good_s_, bad_s_;
  double end_ = 0.0;
  std::uint64_t dwell_ = 0;
};

/// Changes of route, every 20 s + Exp(40 s). During an outage of 0.2 to 2 s all packets are lost;
/// then each direction has another additional delay.
class Roams {
 public:
  Roams(RandomStream random, Way way) : random_(random), down_(way == Way::down) { next_ = step(); }

  /// Returns the additional delay of the route, and whether the route is changing. Call with rising
  /// times.
  Transit at(double t) {
    while (next_ <= t) {
      last_ = next_;
      ++roam_;
      next_ += step();
    }
    if (roam_ == 0) return {};
    const std::uint64_t k = roam_ - 1;
    return {5.0 * ms * random_.uniform(k, down_ ? 3 : 2),
            t < last_ + 0.2 + 1.8 * random_.uniform(k, 1)};
  }

 private:
  double step() const { return 20.0 + random_.exponential(roam_, 0, 40.0); }

  RandomStream random_;
  bool down_;
  std::uint64_t roam_ = 0;
  double last_ = 0.0, next_ = 0.0;
};

// Every packet has a short delay. 8 % wait some milliseconds longer, 0.5 % up to 20 ms.
double quiet_delay(const RandomStream& s, std::uint64_t k) {
  double d = s.exponential(k, 0, 0.25 * ms);
  if (s.chance(k, 1, 0.08)) d += s.exponential(k, 2, 2.0 * ms);
  if (s.chance(k, 3, 0.005)) d += 20.0 * ms * s.uniform(k, 4);
  return d;
}

/// Returns the time until the next beacon that the node receives. The access point keeps a reply
/// until then.
double beacon_wait(const RandomStream& s, std::uint64_t seed, std::uint64_t k, double sent) {
  if (s.chance(k, 4, 0.10)) return 0.0;  // the node is still awake
  const RandomStream link(seed, 3);
  const double period = 0.1024 * (1.0 + 20e-6 * (2.0 * link.uniform(0, 1) - 1.0));
  const double ahead = std::fmod(0.1024 * link.uniform(0, 2) - sent, period);
  return (ahead < 0.0 ? ahead + period : ahead) + (s.chance(k, 3, 0.02) ? period : 0.0);
}

// In the bad state, delays are log-normal, but at most 2 s.
double congested_delay(const RandomStream& s, std::uint64_t k, bool down, bool bad) {
  if (!bad) return s.exponential(k, 2, down ? 6.0 * ms : 3.0 * ms);
  return std::min((down ? 60.0 : 25.0) * ms * std::exp(s.normal(k, 0)), 2.0);
}

struct Packet {
  std::uint64_t k = 0;  // number of the packet in its direction
  double sent = 0.0;
  Way way = Way::up;
  bool bad = false;  // bad state of a link with two states
};

/// Returns the delay in addition to the least delay, s.
double above_floor(Link link, const RandomStream& s, std::uint64_t seed, const Packet& packet) {
  const std::uint64_t k = packet.k;
  const bool down = packet.way == Way::down;
  switch (link) {
    case Link::wired:
      return s.exponential(k, 0, 15e-6) +
             (s.chance(k, 1, 0.01) ? s.exponential(k, 2, 0.2 * ms) : 0.0);
    case Link::quiet:
    case Link::roaming:
      return quiet_delay(s, k);
    case Link::paper:  // 9 % of the packets find an idle channel and an awake radio
      return s.exponential(k, 0, 1.9 * ms) +
             (s.chance(k, 1, 0.91) ? 59.0 * ms * s.uniform(k, 2) : 0.0);
    case Link::thin_floor:
      return s.exponential(k, 0, 13.0 * ms) + s.exponential(k, 2, 13.0 * ms);
    case Link::modem_sleep:
      return s.exponential(k, 0, 0.5 * ms) +
             (s.chance(k, 1, 0.05) ? s.exponential(k, 2, 3.0 * ms) : 0.0) +
             (down ? beacon_wait(s, seed, k, packet.sent) : 0.0);
    case Link::congested:
      return congested_delay(s, k, down, packet.bad);
  }
  return 0.0;
}

// Faults have their own random numbers, so an added fault does not change the rest of the link.
void add_faults(const LinkOptions& options, std::uint64_t seed, Way way,
                std::span<const double> sent, std::vector<Transit>& transits) {
  const RandomStream losses(seed, 60 + number(way));
  const bool down = way == Way::down;
  for (const LinkFault& fault : options.faults) {
    for (std::size_t k = 0; k < sent.size(); ++k) {
      if (sent[k] < fault.begin || sent[k] >= fault.end) continue;
      transits[k].delay += down ? fault.extra_down : fault.extra_up;
      if (losses.chance(k, 0, down ? fault.lost_down : fault.lost_up)) transits[k].lost = true;
    }
  }
}

}  // namespace

// The least delays of the two directions differ by a random asymmetry (fixed for the congested
// link). No exchange can measure this asymmetry.
Floors floors(Link link, std::uint64_t seed) {
  const double asymmetry = 2.0 * RandomStream(seed, 3).uniform(0, 0) - 1.0;
  const auto around = [&](double floor, double spread) {
    return Floors{floor + spread * asymmetry, floor - spread * asymmetry};
  };
  switch (link) {
    case Link::wired:
      return around(60e-6, 5e-6);
    case Link::quiet:
    case Link::roaming:
      return around(1.0 * ms, 0.1 * ms);
    case Link::paper:
      return around(3.5 * ms, 0.1 * ms);
    case Link::thin_floor:
      return around(7.0 * ms, 0.1 * ms);
    case Link::modem_sleep:
      return around(1.5 * ms, 0.1 * ms);
    case Link::congested:
      return {2.0 * ms, 1.5 * ms};
  }
  return {};
}

// Random numbers depend on the number of the packet in its direction. A fault or a later packet
// therefore does not change them.
std::vector<Transit> transits(const LinkOptions& options, std::uint64_t seed, Way way,
                              std::span<const double> sent) {
  const RandomStream random(seed, 10 + number(way));
  const Floors least = floors(options.link, seed);
  const double floor = way == Way::down ? least.down : least.up;
  // `confirm` packets go to the host, so they have the states of that direction.
  Dwells states(RandomStream(seed, 20 + number(way) % 2), 5.0, 3.0);
  Roams roams(RandomStream(seed, 30), way);
  std::vector<Transit> out(sent.size());
  for (std::size_t k = 0; k < sent.size(); ++k) {
    const bool bad = options.link == Link::congested && states.bad(sent[k]);
    out[k].delay = floor + above_floor(options.link, random, seed, {k, sent[k], way, bad});
    out[k].lost = random.chance(k, 8, bad ? 0.20 : shares(options.link).lost);
    if (options.link == Link::roaming) {
      const Transit route = roams.at(sent[k]);
      out[k].delay += route.delay;
      out[k].lost |= route.lost;
    }
  }
  add_faults(options, seed, way, sent, out);
  return out;
}

// Packets of one direction queue in order, except for reordered packets.
std::vector<Arrival> transmit(const LinkOptions& options, std::uint64_t seed, Way way,
                              std::span<const double> sent) {
  const RandomStream random(seed, 40 + number(way));
  const Shares share = shares(options.link);
  Dwells bursts(RandomStream(seed, 50), 2.0, 2.0);
  const std::vector<Transit> way_through = transits(options, seed, way, sent);
  std::vector<Arrival> out(sent.size());
  double last = -1e9;
  for (std::size_t k = 0; k < sent.size(); ++k) {
    double arrival = sent[k] + way_through[k].delay;
    if (random.chance(k, 0, share.reordered + options.reordered)) {
      arrival += 40.0 * ms * random.uniform(k, 1);
    } else {
      last = arrival = std::max(arrival, last + queue_gap_s);  // a lost packet was in the queue too
    }
    // During a burst all packets are lost, in addition to the link's own losses.
    const bool lost = way_through[k].lost || (options.bursts && bursts.bad(sent[k]));
    if (lost) continue;
    out[k].first = arrival;
    if (random.chance(k, 2, share.duplicated + options.duplicated)) {
      out[k].duplicate = arrival + random.exponential(k, 3, 5.0 * ms);
    }
  }
  return out;
}

}  // namespace kinalign
