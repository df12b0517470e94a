// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/senders.h"

#include "kinalign/documents/manifest_toml.h"
#include "kinalign/recording/streams/recording_source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

namespace kinalign {

namespace {

// A chosen limit. While a device reconnects, messages of both connections may arrive for a moment.
constexpr Duration longest_reconnect = std::chrono::seconds(1);

constexpr std::size_t most_named = 8;  // limit on senders in one message

/// The first few names as a list, because any program can add senders.
std::string some_of(std::vector<std::string> names) {
  const std::size_t all = names.size();
  names.resize(std::min(all, most_named));
  const auto more = all > most_named ? fmt::format(" and {} more", all - most_named) : "";
  return fmt::format("{}{}", fmt::join(names, ", "), more);
}

}  // namespace

/// The port follows the last colon. An IPv6 address contains further colons.
std::string host_of(std::string_view sender) {
  return std::string(sender.substr(0, sender.rfind(':')));
}

std::size_t SenderTable::add(const std::string& sender) {
  const auto same = std::find_if(senders_.begin(), senders_.end(),
                                 [&](const Sender& one) { return one.name == sender; });
  if (same == senders_.end()) {
    senders_.push_back({sender});
    return senders_.size() - 1;
  }
  return static_cast<std::size_t>(same - senders_.begin());
}

void SenderTable::count(std::size_t number, HostTime at) {
  Sender& sender = senders_[number];
  if (sender.messages++ == 0) sender.first = at;
  sender.last = at;
}

std::vector<std::string> SenderTable::hosts() const {
  // The messages of all ports of a host are added up, because a device that reconnects uses several
  // ports.
  std::map<std::string, std::uint64_t> messages;
  for (const Sender& sender : senders_) messages[host_of(sender.name)] += sender.messages;
  std::vector<std::string> hosts;
  for (const auto& [host, count] : messages) {
    if (count > 0) hosts.push_back(host);
  }
  std::stable_sort(hosts.begin(), hosts.end(), [&](const std::string& a, const std::string& b) {
    return messages[a] > messages[b];
  });
  return hosts;
}

/// True if two senders sent at the same time and are therefore two devices. A device that
/// reconnects uses one port after the other; a short overlap is accepted.
bool SenderTable::overlap(const Sender& a, const Sender& b) {
  const bool is_within = a.first <= b.first && b.last <= a.last;
  return is_within || std::min(a.last, b.last) - std::max(a.first, b.first) > longest_reconnect;
}

void SenderTable::complete(DeviceChoice& choice) const {
  const auto all = hosts();
  if (choice.sender.empty() && !all.empty()) choice.sender = all.front();
  // The busiest sender is taken first. A less busy sender that overlaps with it is left out.
  std::vector<Sender> busiest_first = senders_, taken;
  std::stable_sort(busiest_first.begin(), busiest_first.end(),
                   [](const Sender& a, const Sender& b) { return a.messages > b.messages; });
  for (const Sender& one : busiest_first) {
    if (host_of(one.name) != choice.sender || one.messages == 0) continue;
    if (std::any_of(taken.begin(), taken.end(),
                    [&](const Sender& busier) { return overlap(busier, one); })) {
      choice.left_out.insert(one.name);
    } else {
      taken.push_back(one);
    }
  }
}

/// Other errors than missing rows do not depend on the sender, so they are returned unchanged.
Error with_senders(Error error, const std::string& chosen, const SenderTable& senders) {
  if (error.kind != ErrorKind::no_rows_in_recording || senders.hosts().size() < 2) return error;
  error.found +=
      fmt::format(" from {}; sender = \"...\" chooses one of {}", chosen, some_of(senders.hosts()));
  return error;
}

Findings judge_senders(const DeviceRequest& request, bool any_sender, const SenderTable& senders) {
  const DeviceChoice& choice = request.choice;
  std::vector<std::string> others(choice.left_out.begin(), choice.left_out.end());
  // If the user selected a sender, other hosts were left out on purpose and are not reported.
  for (const std::string& host : any_sender ? senders.hosts() : std::vector<std::string>()) {
    if (host != choice.sender) others.push_back(host);
  }
  if (others.empty()) return {};
  return {{Severity::warning,
           Error{request.file.path, 0, "one sender of " + choice.stream, "also " + some_of(others)},
           "only the sender with the most messages, " + choice.sender + ", was read",
           "sender = \"...\" in select chooses another, an address or an address with its port"}};
}

/// The lines are the same as in a manifest of this recording, so that the user can copy them.
Error with_nodes(const DeviceRequest& request, const RecordingSurvey& survey, Error error) {
  if (!request.choice.node.empty()) return error;
  std::string path = request.file.path;
  for (const StreamFile& file : request.options.files) {  // the paths as in the manifest
    if (request.file.path.ends_with(file.path)) path = file.path;
  }
  auto manifest = manifest_of(survey, path);
  if (!manifest) return error;
  for (const StreamOptions& stream : manifest->streams) {
    if (stream.name != request.choice.stream || stream.files.size() < 2) continue;
    error.expected = "one node of stream " + shown(stream.name) + ": " +
                     select_toml({{"node", stream.files.front().node}}) +
                     "; or all nodes, with this line instead of file: " + files_toml(stream.files);
  }
  return error;
}

}  // namespace kinalign
