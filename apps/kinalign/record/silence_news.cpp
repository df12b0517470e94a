// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/silence_news.h"

#include "kinalign/capture/net/pieces.h"

#include <algorithm>
#include <map>

namespace kinalign {

namespace {

std::string key_of(const StreamStatus& stream) {
  return name_of(stream) + " from " + stream.sender;
}

/// The key of the sender with the most messages, by the stream's name.
std::map<std::string, std::string> loudest_of(const std::vector<StreamStatus>& streams) {
  std::map<std::string, const StreamStatus*> loudest;
  for (const StreamStatus& stream : streams) {
    const StreamStatus*& one = loudest[name_of(stream)];
    if (one == nullptr || stream.counts.messages > one->counts.messages) one = &stream;
  }
  std::map<std::string, std::string> keys;
  for (const auto& [name, stream] : loudest) keys[name] = key_of(*stream);
  return keys;
}

}  // namespace

std::vector<SilenceNews::Change> SilenceNews::changes(const LabStatus& status) {
  const std::vector<StreamStatus> newest = newest_of_each(status.streams);
  const auto loudest = loudest_of(newest);
  std::vector<Change> changes;
  for (const StreamStatus& stream : newest) {
    const std::string key = key_of(stream);
    if (stream.counts.messages >= Senders::little) known_.insert(key);
    const bool silent = is_silent(stream, status.now);
    const bool is_sender = known_.contains(key) || loudest.at(name_of(stream)) == key;
    if (silent == silent_.contains(key) || (silent && !is_sender)) continue;
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
