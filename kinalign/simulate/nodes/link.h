// SPDX-License-Identifier: Apache-2.0
// Radio and wire between a node and the host: seven links, each by its delays, losses, duplicates
// and reorderings, as docs/clock.md describes them. Seconds; the same seed gives the same link.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

enum class Link : std::uint8_t {
  wired,        // A: a switch
  quiet,        // B: Wi-Fi with modem sleep off
  paper,        // C: d = 33 +- 13 ms, as the paper measured
  modem_sleep,  // D: the downlink waits for a beacon
  congested,    // E: good and bad states, unlike both ways
  roaming,      // F: B with a new route every minute
  thin_floor    // G: d as C's, but hardly a packet near the floor
};
inline constexpr std::uint8_t links = 7;
/// A … G, as the tables name them.
constexpr char letter(Link link) { return static_cast<char>('A' + static_cast<int>(link)); }

enum class Way : std::uint8_t { up = 0, down = 1, confirm = 2 };  // confirm goes up, too

/// A pathology on top of the link's own: each from `begin` to `end`, s, by the time of sending.
struct LinkFault {
  double begin = 0.0, end = 0.0;
  double lost_up = 0.0, lost_down = 0.0;    // share that is lost on top
  double extra_up = 0.0, extra_down = 0.0;  // s, a longer route
};

struct LinkOptions {
  Link link = Link::quiet;
  bool bursts = false;      // 2 s of total loss and 2 s without in turn, on the average
  double duplicated = 0.0;  // share, on top of the link's own
  double reordered = 0.0;   // share that comes up to 40 ms later than it would
  std::vector<LinkFault> faults{};
};

/// The least one-way delays of the link, s.
struct Floors {
  double up = 0.0, down = 0.0;
};
Floors floors(Link link, std::uint64_t seed);

struct Transit {
  double delay = 0.0;  // s, before it queues behind earlier packets
  bool lost = false;
};
/// Of packets sent at these rising times.
std::vector<Transit> transits(const LinkOptions& options, std::uint64_t seed, Way way,
                              std::span<const double> sent);

struct Arrival {
  std::optional<double> first, duplicate;
};
/// In order but for the reordered few, at least 20 us apart; absent: lost.
std::vector<Arrival> transmit(const LinkOptions& options, std::uint64_t seed, Way way,
                              std::span<const double> sent);

}  // namespace kinalign
