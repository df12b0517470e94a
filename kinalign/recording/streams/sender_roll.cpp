// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/sender_roll.h"

#include <algorithm>

namespace kinalign {

namespace {

// Chosen: who is silent for longer has gone. The slowest of the devices says something twice a
// second.
constexpr Duration still_there = std::chrono::seconds(1);

}  // namespace

std::string host_of(std::string_view sender) {
  return std::string(sender.substr(0, sender.rfind(':')));
}

std::size_t SenderRoll::add(const std::string& sender) {
  const auto [at, fresh] = numbers_.try_emplace(sender, senders_.size());
  if (fresh) senders_.push_back({sender, host_of(sender)});
  return at->second;
}

void SenderRoll::hear(std::size_t number, HostTime at) {
  Sender& sender = senders_[number];
  const auto [last, fresh] = speaking_.try_emplace(sender.host, number);
  if (!fresh && last->second != number) {
    if (sender.messages > 0 && at - sender.last < still_there) ++sender.between[last->second];
    last->second = number;
  }
  ++sender.messages;
  sender.last = at;
}

std::vector<std::string> SenderRoll::hosts() const {
  std::map<std::string, std::uint64_t> messages;
  for (const Sender& sender : senders_) {
    if (sender.messages > 0) messages[sender.host] += sender.messages;
  }
  std::vector<std::string> hosts;
  hosts.reserve(messages.size());
  for (const auto& [host, count] : messages) hosts.push_back(host);
  std::stable_sort(hosts.begin(), hosts.end(), [&](const std::string& a, const std::string& b) {
    return messages[a] > messages[b];
  });
  return hosts;
}

std::vector<std::size_t> SenderRoll::of_host(std::string_view host) const {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < senders_.size(); ++i) {
    if (senders_[i].host == host && senders_[i].messages > 0) found.push_back(i);
  }
  std::stable_sort(found.begin(), found.end(), [this](std::size_t a, std::size_t b) {
    return senders_[a].messages > senders_[b].messages;
  });
  return found;
}

/// Of the one that says less: a tenth of its messages stood between two of the other's, or the
/// other way around. Chosen: while a connection is made anew some come from both.
bool SenderRoll::is_beside(std::size_t a, std::size_t b) const {
  const auto between = [this](std::size_t one, std::size_t other) {
    const auto found = senders_[one].between.find(other);
    return found == senders_[one].between.end() ? 0 : found->second;
  };
  const std::uint64_t less = std::min(senders_[a].messages, senders_[b].messages);
  return 10 * (between(a, b) + between(b, a)) > less;
}

std::set<std::string> SenderRoll::beside(std::string_view host) const {
  std::vector<std::size_t> taken;
  std::set<std::string> others;
  for (const std::size_t one : of_host(host)) {
    const bool in_turn = std::any_of(taken.begin(), taken.end(),
                                     [&](std::size_t busier) { return is_beside(busier, one); });
    if (in_turn) {
      others.insert(senders_[one].name);
    } else {
      taken.push_back(one);
    }
  }
  return others;
}

std::vector<std::string> SenderRoll::senders(std::string_view host) const {
  std::vector<std::string> names;
  for (const std::size_t one : of_host(host)) names.push_back(senders_[one].name);
  return names;
}

}  // namespace kinalign
