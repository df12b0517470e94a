// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/import/ids.h"

#include <algorithm>

namespace kinalign {

namespace {

constexpr std::size_t longest = 60;  // leaves room for a number at the end

/// Only ASCII letters count, because BIDS allows no others in a label and the locale must not
/// matter.
bool is_small(char c) { return c >= 'a' && c <= 'z'; }
bool is_latin(char c) { return is_small(c) || (c >= 'A' && c <= 'Z'); }
bool is_figure(char c) { return c >= '0' && c <= '9'; }

/// Ids are compared in lower case, because some file systems ignore case.
std::string in_small(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return text;
}

}  // namespace

std::string label_of(std::string_view word) {
  std::string out;
  bool is_behind_gap = false;
  for (const char c : word) {
    if (!is_latin(c) && !is_figure(c)) {
      // Characters that are dropped at the beginning do not count as a gap.
      is_behind_gap = !out.empty();
      continue;
    }
    // The first letter after a gap becomes a capital, so that words stay readable.
    out += is_behind_gap && is_small(c) ? static_cast<char>(c - 32) : c;
    is_behind_gap = false;
    if (out.size() == longest) break;
  }
  return out.empty() ? "x" : out;
}

Ids::Ids(const std::vector<std::pair<std::string, std::string>>& known) {
  for (const auto& [id, name] : known) {
    names_[id] = name;
    taken_.insert(in_small(id));
  }
}

/// True if the id can be used for the word: it is free, or an earlier import made it from this
/// word. A known id can also be used if it equals the word and was not made from its name.
bool Ids::is_free(const std::string& id, const std::string& word) const {
  if (!taken_.contains(in_small(id))) return true;
  const auto known = names_.find(id);
  // The id differs from a known one only in case, or was given to another word.
  if (known == names_.end()) return false;
  for (const auto& [other, given] : given_) {
    // Two words never get the same id in one import.
    if (given == id) return false;
  }
  return known->second == word || (id == word && label_of(known->second) != id);
}

std::string Ids::of(const std::string& word) {
  if (const auto known = given_.find(word); known != given_.end()) return known->second;
  const std::string label = label_of(word);
  std::string id = label;
  // If the id is taken, a number is appended: walk, walkx2, walkx3.
  for (int number = 2; !is_free(id, word); ++number) id = label + "x" + std::to_string(number);
  // From now on no other word can get this id.
  taken_.insert(in_small(id));
  given_[word] = id;
  return id;
}

std::vector<std::pair<std::string, std::string>> Ids::changed() const {
  std::vector<std::pair<std::string, std::string>> out;
  for (const auto& [word, id] : given_) {
    if (word != id) out.emplace_back(word, id);
  }
  return out;
}

}  // namespace kinalign
