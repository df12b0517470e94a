// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/sender_choice.h"

#include "kinalign/documents/manifest_toml.h"
#include "kinalign/recording/streams/recording_source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace kinalign {

namespace {

constexpr std::size_t most_named = 8;

std::string some_of(std::vector<std::string> names) {
  const std::size_t all = names.size();
  names.resize(std::min(all, most_named));
  const auto more = all > most_named ? fmt::format(" and {} more", all - most_named) : "";
  return fmt::format("{}{}", fmt::join(names, ", "), more);
}

}  // namespace

std::vector<DeviceChoice> choices(const DeviceChoice& wished, const SenderRoll& senders) {
  constexpr std::size_t most_choices = 8;  // each takes a pass over the file
  std::vector<std::string> hosts{wished.sender};
  if (wished.sender.empty()) hosts = senders.hosts();
  if (hosts.empty()) return {wished};  // nodes
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
  for (const StreamFile& file : wish.options.files) {  // as the manifest has it
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
