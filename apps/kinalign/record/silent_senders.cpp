// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/silent_senders.h"

#include "kinalign/capture/net/pieces.h"

#include <algorithm>

namespace kinalign {

namespace {

/// True for a sender of few messages if another sender of the same stream has more.
bool may_be_unknown(const StreamStatus& stream, const std::vector<StreamStatus>& all) {
  if (stream.counts.messages >= Senders::little) return false;
  return std::any_of(all.begin(), all.end(), [&](const StreamStatus& other) {
    return name_of(other) == name_of(stream) && other.counts.messages > stream.counts.messages;
  });
}

}  // namespace

std::vector<SilentSenders::Change> SilentSenders::changes(const LabStatus& status) {
  // A sender that reconnects has several entries. Only the newest one can be silent.
  const std::vector<StreamStatus> newest = newest_of_each(status.streams);
  std::vector<Change> changes;
  for (const StreamStatus& stream : newest) {
    // The name alone is not enough: two senders of one device are told apart by their addresses.
    const std::string key = name_of(stream) + " from " + stream.sender;
    const bool silent = is_silent(stream, status.now);
    if (silent == silent_.contains(key) || (silent && may_be_unknown(stream, newest))) continue;
    if (silent) {
      silent_.insert(key);
    } else {
      silent_.erase(key);
    }
    changes.push_back({stream, silent});
  }
  return changes;
}

}  // namespace kinalign
