// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/import/file_names.h"

#include "kinalign/dataset/import/source_files.h"

#include <algorithm>
#include <charconv>

namespace kinalign {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The name without "Char00" at its end, which Axis Neuron adds for each character of a recording.
std::string_view without_character(std::string_view stem) {
  const auto at = stem.rfind("Char");
  return at != stem.npos && at > 0 && whole_number(stem.substr(at + 4)) ? stem.substr(0, at) : stem;
}

/// Reads a name: a number at its end is the run, the text before it the action.
void read_action(std::string_view stem, FileSays& out) {
  stem = without_character(stem);
  std::size_t end = stem.size();
  while (end > 0 && is_digit(stem[end - 1])) --end;
  // The separator before the run belongs neither to the run nor to the action.
  if (const auto run = whole_number(stem.substr(end))) {
    out.run = *run;
    stem = stem.substr(0, end);
    while (!stem.empty() && (stem.back() == '_' || stem.back() == '-' || stem.back() == ' ')) {
      stem.remove_suffix(1);
    }
  }
  out.action = stem;
}

/// Reads a name of CMU's form, two numbers for subject and trial. False for other names.
bool read_cmu(std::string_view stem, FileSays& out) {
  const auto line = stem.find('_');
  if (line == stem.npos) return false;
  const std::string_view subject = stem.substr(0, line);
  const auto trial = whole_number(stem.substr(line + 1));
  if (!whole_number(subject) || !trial) return false;
  out.subject = subject;
  out.run = *trial;
  return true;
}

/// The folders of a name, from the outside in.
std::vector<std::string_view> folders_of(std::string_view name) {
  std::vector<std::string_view> out;
  for (auto slash = name.find('/'); slash != name.npos; slash = name.find('/')) {
    out.push_back(name.substr(0, slash));
    name.remove_prefix(slash + 1);
  }
  return out;
}

/// The number of folders at the beginning that all names have in common.
std::size_t shared_folders(const std::vector<std::string>& names) {
  if (names.empty()) return 0;
  const auto first = folders_of(names.front());
  std::size_t shared = first.size();
  for (const std::string& name : names) {
    const auto own = folders_of(name);
    const auto [end, _] = std::mismatch(first.begin(), first.end(), own.begin(), own.end());
    shared = std::min(shared, static_cast<std::size_t>(end - first.begin()));
  }
  return shared;
}

}  // namespace

// A number with more than six digits does not count as a run.
std::optional<std::uint32_t> whole_number(std::string_view text) {
  if (text.empty() || text.size() > 6 || !std::all_of(text.begin(), text.end(), is_digit)) {
    return std::nullopt;
  }
  std::uint32_t value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

bool take_digits(std::string_view& text, std::string_view lead, std::size_t digits,
                 std::uint32_t& out) {
  if (!text.starts_with(lead)) return false;
  const std::string_view number = text.substr(lead.size(), digits);
  const auto value = whole_number(number);
  if (!value || number.size() != digits) return false;
  out = *value;
  text.remove_prefix(lead.size() + digits);
  return true;
}

std::vector<FileSays> read_file_names(const std::vector<std::string>& names) {
  const std::size_t shared = shared_folders(names);
  // The folders below the common ones are people's, unless a file lies outside of them.
  const bool has_people = std::all_of(names.begin(), names.end(), [&](const std::string& name) {
    return folders_of(name).size() > shared;
  });
  std::vector<FileSays> out;
  for (const std::string& name : names) {
    FileSays& says = out.emplace_back();
    // CMU's form is tried first, because its two numbers look like an action and a run.
    if (read_cmu(stem_of(name), says)) continue;
    read_action(stem_of(name), says);
    const auto folders = folders_of(name);
    if (has_people) {
      says.subject = folders[shared];
    } else if (shared > 0) {
      // If all files lie in one folder, the folder's name is the person.
      says.subject = folders[shared - 1];
    }
  }
  return out;
}

}  // namespace kinalign
