// SPDX-License-Identifier: Apache-2.0
// Makes ids of people and actions from a corpus's own words: letters and digits (take_name.h), a
// different id for each word.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinalign {

/// The word's letters and digits, at most 60. A letter after a dropped character becomes a capital:
/// "slow walk" gives slowWalk. The result is "x" if no letter or digit remains.
std::string label_of(std::string_view word);

/// Gives ids to words. Ids that differ only in case count as one, since some file systems ignore
/// case.
class Ids {
 public:
  /// `known`: existing ids with their names. A name is the word from which an earlier import made
  /// the id, or another text.
  explicit Ids(const std::vector<std::pair<std::string, std::string>>& known);

  /// The same word always gets the same id.
  std::string of(const std::string& word);
  /// Words that differ from their ids.
  std::vector<std::pair<std::string, std::string>> changed() const;

 private:
  bool is_free(const std::string& id, const std::string& word) const;

  std::map<std::string, std::string> names_;  // names of known ids
  std::map<std::string, std::string> given_;  // by word
  std::set<std::string> taken_;               // ids in lower case
};

}  // namespace kinalign
