// SPDX-License-Identifier: Apache-2.0
// Ids of people and actions out of a corpus' own words: letters and digits (take_name.h), no two
// words with one id.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinalign {

/// The word's letters and digits, at most 60; a letter behind something that was left out is made a
/// large one: "slow walk" is slowWalk. "x" where nothing is left.
std::string label_of(std::string_view word);

/// Gives ids to words. Ids that differ in large and small letters alone count as one: some file
/// systems know no difference.
class Ids {
 public:
  /// `known`: ids that are there, each with its name, which is the word that it was made of or some
  /// other text.
  explicit Ids(const std::vector<std::pair<std::string, std::string>>& known);

  /// The same id for the same word.
  std::string of(const std::string& word);
  /// Words that are not their own ids.
  std::vector<std::pair<std::string, std::string>> changed() const;

 private:
  bool is_free(const std::string& id, const std::string& word) const;

  std::map<std::string, std::string> names_;  // of known ids
  std::map<std::string, std::string> given_;  // by word
  std::set<std::string> taken_;               // ids in small letters
};

}  // namespace kinalign
