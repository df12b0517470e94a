// SPDX-License-Identifier: Apache-2.0
// Reads the keys of a layout file, each with its line for messages. Only its .cpp includes toml++.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A table of the file, or the file itself.
class LayoutKeys {
 public:
  using Names = std::vector<std::string_view>;

  /// Fails if the text is no TOML, or at a key that is not in `known`.
  static Result<LayoutKeys> parse(std::string_view toml, std::string_view file, const Names& known);

  /// An inner table. If `known` is empty, it may have any keys.
  Result<LayoutKeys> table(std::string_view key, const Names& known) const;

  bool has(std::string_view key) const;
  bool is_table(std::string_view key) const;
  bool is_text(std::string_view key) const;
  std::vector<std::string> keys() const;  // in alphabetical order

  Result<std::string> text(std::string_view key) const;  // a number is returned as its text
  Result<std::string> text(std::string_view key, std::string_view otherwise) const;
  Result<bool> truth(std::string_view key, bool otherwise) const;
  Result<std::size_t> count(std::string_view key, std::size_t otherwise) const;  // up to 100,000
  Result<double> positive(std::string_view key, double otherwise) const;         // from 1e-9 to 1e9
  Result<std::vector<double>> numbers(std::string_view key) const;  // an array or a single number
  Result<std::vector<std::string>> texts(std::string_view key) const;

  /// An error at the key's line; if the key is absent, at the table's line.
  Error error(std::string_view key, std::string expected, std::string found) const;

 private:
  struct Document;
  LayoutKeys(std::shared_ptr<const Document> document, const void* table);
  Failure wrong(std::string_view key, std::string expected) const;
  Result<void> check_known(const Names& known) const;

  std::shared_ptr<const Document> document_;  // shared by all tables of the file
  const void* table_;                         // a toml::table of the document
};

}  // namespace kinalign
