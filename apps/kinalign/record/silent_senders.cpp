// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/silent_senders.h"

#include "kinalign/capture/net/pieces.h"

#include <algorithm>

namespace kinalign {

namespace {

/// True if a sender has sent few messages and another sender of the same stream has sent more.
bool may_be_unknown(const StreamStatus& stream, const std::vector<StreamStatus>& all) {
  if (stream.counts.messages >= Senders::little) return false;
  return std::any_of(all.begin(), all.end(), [&](const StreamStatus& other) {
    return name_of(other) == name_of(stream) && other.counts.messages > stream.counts.messages;
  });
}

}  // namespace

std::vector<SilentSenders::Change> SilentSenders::changes(const LabStatus& status) {
  // A sender that reconnects has several entries. Only the newest entry counts.
  const std::vector<StreamStatus> newest = newest_of_each(status.streams);
  std::vector<Change> changes;
  for (const StreamStatus& stream : newest) {
    // Two senders of one device have the same name, so the address is part of the key.
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
