// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/senders.h"

#include "kinalign/documents/manifest_toml.h"
#include "kinalign/recording/streams/recording_source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace kinalign {

namespace {

// A choice: a sender that is silent for longer is considered gone. The slowest devices send twice a
// second.
constexpr Duration still_there = std::chrono::seconds(1);

constexpr std::size_t most_named = 8;  // senders named in one message

std::string some_of(std::vector<std::string> names) {
  const std::size_t all = names.size();
  names.resize(std::min(all, most_named));
  const auto more = all > most_named ? fmt::format(" and {} more", all - most_named) : "";
  return fmt::format("{}{}", fmt::join(names, ", "), more);
}

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

/// Returns whether two senders sent at the same time. They did if more than a tenth of the messages
/// of the less active one alternate with those of the other. The limit is a choice: while a device
/// reconnects, a few messages arrive from both connections.
bool SenderRoll::is_beside(std::size_t a, std::size_t b) const {
  const auto between = [this](std::size_t one, std::size_t other) {
    const auto found = senders_[one].between.find(other);
    return found == senders_[one].between.end() ? 0 : found->second;
  };
  const std::uint64_t less = std::min(senders_[a].messages, senders_[b].messages);
  return 10 * (between(a, b) + between(b, a)) > less;
}

// The senders of the address are taken in the order of their message counts.
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

std::vector<DeviceChoice> choices(const DeviceChoice& wished, const SenderRoll& senders) {
  constexpr std::size_t most_choices = 8;  // each needs a pass over the file
  std::vector<std::string> hosts{wished.sender};
  if (wished.sender.empty()) hosts = senders.hosts();
  if (hosts.empty()) return {wished};  // nodes have no sender to choose
  hosts.resize(std::min(hosts.size(), most_choices));
  std::vector<DeviceChoice> all;
  for (const std::string& host : hosts) {
    all.push_back(wished);
    all.back().sender = host;
    all.back().passed_over = senders.beside(host);
  }
  return all;
}

Error with_senders(Error error, const std::string& chosen, const SenderRoll& senders) {
  if (senders.hosts().size() < 2) return error;
  error.found +=
      fmt::format(" from {}; heard were {}: select.sender", chosen, some_of(senders.hosts()));
  return error;
}

Error with_nodes(const DeviceWish& wish, const RecordingSurvey& survey, Error error) {
  if (!wish.choice.node.empty()) return error;
  std::string path = wish.file.path;
  for (const StreamFile& file : wish.options.files) {  // the path as written in the manifest
    if (wish.file.path.ends_with(file.path)) path = file.path;
  }
  auto manifest = manifest_of(survey, path);
  if (!manifest) return error;
  for (const StreamOptions& stream : manifest->streams) {
    if (stream.name != wish.choice.stream || stream.files.size() < 2) continue;
    error.expected = "one node of stream " + shown(stream.name) + ": " +
                     select_toml({{"node", stream.files.front().node}}) +
                     "; or all of them, in place of file: " + files_toml(stream.files);
  }
  return error;
}

Findings judge_senders(const DeviceWish& wish, bool any_sender, const SenderRoll& senders) {
  const DeviceChoice& choice = wish.choice;
  Findings findings;
  const auto tell = [&](const std::string& one, const std::vector<std::string>& heard,
                        const std::string& meaning, const char* repair) {
    findings.push_back(
        {Severity::warning, Error{wish.file.path, 0, one, some_of(heard)}, meaning, repair});
  };
  if (any_sender && senders.hosts().size() > 1) {
    tell("one sender of " + choice.stream, senders.hosts(), "only " + choice.sender + " was read",
         "select.sender names another");
  }
  if (!choice.passed_over.empty()) {
    tell("one sender of " + choice.stream + " at " + choice.sender, senders.senders(choice.sender),
         "of those that speak in turn only the one that said most was read",
         "select.sender names another, with its port");
  }
  return findings;
}

}  // namespace kinalign
