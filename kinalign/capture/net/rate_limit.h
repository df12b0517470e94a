// SPDX-License-Identifier: Apache-2.0
// How often a stranger is answered: a table of fixed size, whatever arrives. Time is an argument.
#pragma once

#include "kinalign/wire/time.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace kinalign {

/// A bucket of 8 answers for each address, filled by one in 2 s: enough for the bursts of clients
/// (chrony's iburst sends 4 to 8, ntpdig's -p 4 four at once).
class RateLimit {
 public:
  static constexpr std::int64_t burst = 8;
  static constexpr Duration interval = std::chrono::seconds(2);
  static constexpr std::size_t ways = 4, entries = 65'536;
  static constexpr std::uint64_t drops_per_kiss = 16;

  enum class Verdict : std::uint8_t { answer, drop, kiss };

  RateLimit() : sets_(entries / ways) {}

  /// One request more. `hash`: of the address, keyed by what nobody outside knows, so that nobody
  /// can choose addresses that push another's entry out.
  Verdict ask(std::uint64_t hash, HostTime now);

 private:
  struct Entry {
    std::uint64_t hash = 0;
    HostTime full_at{HostTime::min()};  // when the bucket is full again; past: it is
  };
  struct alignas(64) Set {  // a line of the cache
    std::array<Entry, ways> entries;
  };
  static Entry& entry_of(Set& set, std::uint64_t hash);

  std::vector<Set> sets_;
  std::uint64_t drops_ = 0;
};

}  // namespace kinalign
