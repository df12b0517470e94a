// SPDX-License-Identifier: Apache-2.0
// Limits how often an unknown sender is answered. The table has a fixed size. Time is an argument.
#pragma once

#include "kinalign/wire/time.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace kinalign {

/// A token bucket of 8 answers for each address, refilled by one every 2 s. This is enough for the
/// bursts of clients: chrony's iburst sends 4 to 8 requests, ntpdig's -p 4 sends four at once.
class RateLimit {
 public:
  static constexpr std::int64_t burst = 8;
  static constexpr Duration interval = std::chrono::seconds(2);
  static constexpr std::size_t ways = 4, entries = 65'536;
  static constexpr std::uint64_t drops_per_kiss = 16;

  /// `kiss`: refused, but answered with the advice to ask less often. One of 16 refusals gets it.
  enum class Verdict : std::uint8_t { answer, drop, kiss };

  RateLimit() : sets_(entries / ways) {}

  /// Counts one more request. `hash` is a keyed hash of the address. The key is secret, so that
  /// nobody can choose addresses that evict another address's entry.
  Verdict ask(std::uint64_t hash, HostTime now);

 private:
  /// An entry that was never used is a full bucket, so the table needs no flags.
  struct Entry {
    std::uint64_t hash = 0;
    // the time when the bucket is full again; it is full if that is past
    HostTime full_at{HostTime::min()};
  };
  struct alignas(64) Set {  // one cache line
    std::array<Entry, ways> entries;
  };
  static Entry& entry_of(Set& set, std::uint64_t hash);

  std::vector<Set> sets_;
  std::uint64_t drops_ = 0;
};

}  // namespace kinalign
