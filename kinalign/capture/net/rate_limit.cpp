// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/rate_limit.h"

#include <algorithm>

namespace kinalign {

/// Returns the entry of the address. If there is none, the entry with the fullest bucket is
/// replaced, because losing that entry allows the fewest additional answers.
RateLimit::Entry& RateLimit::entry_of(Set& set, std::uint64_t hash) {
  const auto own = std::find_if(set.entries.begin(), set.entries.end(),
                                [hash](const Entry& entry) { return entry.hash == hash; });
  if (own != set.entries.end()) return *own;
  Entry& taken =
      *std::min_element(set.entries.begin(), set.entries.end(),
                        [](const Entry& a, const Entry& b) { return a.full_at < b.full_at; });
  taken = Entry{hash};
  return taken;
}

RateLimit::Verdict RateLimit::ask(std::uint64_t hash, HostTime now) {
  // The bucket is stored as the time at which it is full again. Each answer adds `interval`.
  Entry& entry = entry_of(sets_[hash % sets_.size()], hash);
  const HostTime full_at = std::max(entry.full_at, now) + interval;
  if (full_at - now <= burst * interval) {
    entry.full_at = full_at;
    return Verdict::answer;
  }
  return ++drops_ % drops_per_kiss == 0 ? Verdict::kiss : Verdict::drop;
}

}  // namespace kinalign
