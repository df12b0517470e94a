// SPDX-License-Identifier: Apache-2.0
// Limits how often an unknown sender gets an answer. The table has a fixed size. The caller passes
// the time.
#pragma once

#include "kinalign/wire/time.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace kinalign {

/// Each address may get 8 answers at once, and one more every 2 s (a token bucket). This suffices
/// for the bursts of clients: chrony's iburst sends 4 to 8 requests, ntpdig's -p 4 sends four at
/// once.
class RateLimit {
 public:
  static constexpr std::int64_t burst = 8;
  static constexpr Duration interval = std::chrono::seconds(2);
  static constexpr std::size_t ways = 4, entries = 65'536;
  static constexpr std::uint64_t drops_per_kiss = 16;

  /// `kiss`: no answer, but the advice to ask less often. One of 16 refused requests gets it.
  enum class Verdict : std::uint8_t { answer, drop, kiss };

  RateLimit() : sets_(entries / ways) {}

  /// Counts one more request of an address. `hash` is a hash of the address with a secret key.
  /// Without the key, no one can choose addresses that replace another address's entry.
  Verdict ask(std::uint64_t hash, HostTime now);

 private:
  /// A new entry is a full bucket, so the table needs no flag for unused entries.
  struct Entry {
    std::uint64_t hash = 0;
    // the time when the bucket is full again; in the past: it is full
    HostTime full_at{HostTime::min()};
  };
  struct alignas(64) Set {  // has the size of one cache line
    std::array<Entry, ways> entries;
  };
  static Entry& entry_of(Set& set, std::uint64_t hash);

  std::vector<Set> sets_;
  std::uint64_t drops_ = 0;
};

}  // namespace kinalign
