// SPDX-License-Identifier: Apache-2.0
// Simulated links between a node and the host. docs/simulated_links.md describes the delays,
// losses, duplicates and reorderings of the seven kinds. Times are in seconds. The same seed gives
// the same link.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

enum class Link : std::uint8_t {
  wired,        // A: cable and switch
  quiet,        // B: Wi-Fi, little traffic, without modem sleep
  paper,        // C: delay of 33 +- 13 ms, as measured in the HFUT-MMD paper
  modem_sleep,  // D: packets to the node wait for a beacon
  congested,    // E: good and bad states, different in both directions
  roaming,      // F: like B, with a new route every minute
  thin_floor    // G: mean delay as in C, but hardly any packet has the least delay
};
inline constexpr std::uint8_t links = 7;
/// Returns the letter of a link, A to G, as in the tables of docs/.
constexpr char letter(Link link) { return static_cast<char>('A' + static_cast<int>(link)); }

// `confirm` packets go to the host, like `up` packets.
enum class Way : std::uint8_t { up = 0, down = 1, confirm = 2 };

/// A fault in addition to the link's own behaviour. It applies to packets sent from `begin` to
/// `end`, s.
struct LinkFault {
  double begin = 0.0, end = 0.0;
  double lost_up = 0.0, lost_down = 0.0;    // additional share of lost packets
  double extra_up = 0.0, extra_down = 0.0;  // additional delay, s, as on a longer route
};

/// A kind of link, with effects in addition to its own behaviour.
struct LinkOptions {
  Link link = Link::quiet;
  bool bursts = false;      // total loss for 2 s and no such loss for 2 s in turn, on average
  double duplicated = 0.0;  // share of packets, in addition to the link's own
  double reordered = 0.0;   // share of packets that arrive up to 40 ms later
  std::vector<LinkFault> faults{};
};

/// The least delay in each direction, s.
struct Floors {
  double up = 0.0, down = 0.0;
};
Floors floors(Link link, std::uint64_t seed);

struct Transit {
  double delay = 0.0;  // s, without waiting behind earlier packets
  bool lost = false;
};
/// Returns the delays of packets that are sent at the rising times `sent`.
std::vector<Transit> transits(const LinkOptions& options, std::uint64_t seed, Way way,
                              std::span<const double> sent);

struct Arrival {
  std::optional<double> first, duplicate;
};
/// Returns the arrivals; absent: lost. Except for reordered packets, they are in order and at least
/// 20 us apart.
std::vector<Arrival> transmit(const LinkOptions& options, std::uint64_t seed, Way way,
                              std::span<const double> sent);

}  // namespace kinalign
