// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/take_name.h"

#include "kinalign/core/numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace kinalign {

namespace {

// The longest label, and the endings of the three kinds of file.
constexpr std::size_t longest_label = 64;
constexpr std::array<std::pair<TakeFile, std::string_view>, 3> endings{
    {{TakeFile::manifest, "_recording.toml"},
     {TakeFile::take, "_take.h5"},
     {TakeFile::summary, "_take.json"}}};

/// Removes `lead` and the label after it from the front of `text`, and returns the label.
std::optional<std::string> take_label(std::string_view& text, std::string_view lead) {
  if (!text.starts_with(lead)) return std::nullopt;
  text.remove_prefix(lead.size());
  const std::string_view label = text.substr(0, text.find('_'));
  text.remove_prefix(label.size());
  return is_label(label) ? std::optional(std::string(label)) : std::nullopt;
}

}  // namespace

bool is_label(std::string_view text) {
  return !text.empty() && text.size() <= longest_label &&
         std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
         });
}

std::string to_string(const TakeName& name) {
  return fmt::format("sub-{}_task-{}_run-{:02}", name.subject, name.action, name.run);
}

std::optional<TakeName> parse_take_name(std::string_view text) {
  // Each step removes its part from the front. In the end no text may be left.
  const auto subject = take_label(text, "sub-");
  const auto action = take_label(text, "_task-");
  const auto run = take_label(text, "_run-");
  if (!subject || !action || !run || !text.empty()) return std::nullopt;
  TakeName name{*subject, *action, 0};
  if (!parse_integer(*run, name.run) || name.run == 0) return std::nullopt;
  return name;
}

std::string path_of(const TakeName& name, TakeFile file) {
  const auto* const ending = std::find_if(endings.begin(), endings.end(),
                                          [file](const auto& one) { return one.first == file; });
  return fmt::format("sub-{}/{}{}", name.subject, to_string(name), ending->second);
}

std::string path_of(const std::string& folder, const TakeName& name, TakeFile file) {
  return folder + "/" + path_of(name, file);
}

std::string folder_of(const std::string& folder, const TakeName& name) {
  return folder + "/sub-" + name.subject + "/";
}

std::optional<std::pair<TakeName, TakeFile>> parse_take_path(std::string_view path) {
  const auto slash = path.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const std::string_view file = path.substr(slash + 1);
  for (const auto& [kind, ending] : endings) {
    if (!file.ends_with(ending)) continue;
    const auto name = parse_take_name(file.substr(0, file.size() - ending.size()));
    // The path must be exactly the path of that take. A path with another folder or another number
    // of digits is not accepted.
    if (name && path_of(*name, kind) == path) return std::pair(*name, kind);
  }
  return std::nullopt;
}

std::string raw_folder(const TakeName& name) {
  return "sourcedata/sub-" + name.subject + "/" + to_string(name) + "/";
}

}  // namespace kinalign
