// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/silent_senders.h"

#include "kinalign/capture/net/pieces.h"

#include <algorithm>

namespace kinalign {

namespace {

bool may_be_stranger(const StreamStatus& stream, const std::vector<StreamStatus>& all) {
  if (stream.counts.messages >= Senders::little) return false;
  return std::any_of(all.begin(), all.end(), [&](const StreamStatus& other) {
    return name_of(other) == name_of(stream) && other.counts.messages > stream.counts.messages;
  });
}

}  // namespace

std::vector<SilentSenders::Change> SilentSenders::changes(const LabStatus& status) {
  const std::vector<StreamStatus> newest = newest_of_each(status.streams);
  std::vector<Change> changes;
  for (const StreamStatus& stream : newest) {
    const std::string key = name_of(stream) + " from " + stream.sender;
    const bool silent = is_silent(stream, status.now);
    if (silent == silent_.contains(key) || (silent && may_be_stranger(stream, newest))) continue;
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
