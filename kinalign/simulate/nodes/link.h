// SPDX-License-Identifier: Apache-2.0
// Links between a node and the host: seven kinds, with the delays, losses, duplicates and
// reorderings that docs/simulated_links.md describes. Times are in seconds; the same seed gives the
// same link.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

enum class Link : std::uint8_t {
  wired,        // A: a switch
  quiet,        // B: Wi-Fi without modem sleep
  paper,        // C: d = 33 +- 13 ms, as the paper measured
  modem_sleep,  // D: the downlink waits for a beacon
  congested,    // E: good and bad states, different in both directions
  roaming,      // F: B with a new route every minute
  thin_floor    // G: d as in C, but hardly a packet near the floor
};
inline constexpr std::uint8_t links = 7;
/// A … G, as in the tables.
constexpr char letter(Link link) { return static_cast<char>('A' + static_cast<int>(link)); }

enum class Way : std::uint8_t { up = 0, down = 1, confirm = 2 };  // `confirm` packets go up too

/// A fault in addition to the link's own behaviour, for packets sent from `begin` to `end`, s.
struct LinkFault {
  double begin = 0.0, end = 0.0;
  double lost_up = 0.0, lost_down = 0.0;    // additional share that is lost
  double extra_up = 0.0, extra_down = 0.0;  // s, as on a longer route
};

/// The members below `link` add to the link's own behaviour.
struct LinkOptions {
  Link link = Link::quiet;
  bool bursts = false;      // alternately 2 s of total loss and 2 s without loss, on average
  double duplicated = 0.0;  // share, in addition to the link's own
  double reordered = 0.0;   // share that arrives up to 40 ms later
  std::vector<LinkFault> faults{};
};

/// The least delays of the link in each direction, s.
struct Floors {
  double up = 0.0, down = 0.0;
};
Floors floors(Link link, std::uint64_t seed);

struct Transit {
  double delay = 0.0;  // s, before the packet queues behind earlier ones
  bool lost = false;
};
/// The delays of packets that are sent at the rising times `sent`.
std::vector<Transit> transits(const LinkOptions& options, std::uint64_t seed, Way way,
                              std::span<const double> sent);

struct Arrival {
  std::optional<double> first, duplicate;
};
/// Arrivals in order, except for the few reordered ones, at least 20 us apart; absent: lost.
std::vector<Arrival> transmit(const LinkOptions& options, std::uint64_t seed, Way way,
                              std::span<const double> sent);

}  // namespace kinalign
