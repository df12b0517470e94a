// SPDX-License-Identifier: Apache-2.0
// Collects the head of a BVH file (the part above its rows) from pieces of the file.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/formats/bvh/bvh.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace kinalign {

/// Words are separated by blanks, tabs, line ends and all other control characters.
inline bool is_blank(char c) { return static_cast<unsigned char>(c) <= ' '; }

/// Collects the head in text_, at most 8 MiB. When the head is complete, text_ contains the head
/// and the first rows.
class BvhHead {
 public:
  explicit BvhHead(std::string name) : name_(std::move(name)) {}

  /// Adds a piece. Returns true when the head is complete: then `hierarchy` is parsed, and rows()
  /// is the text after the head. Fails if the hierarchy can't be understood or does not end within
  /// 8 MiB.
  Result<bool> add(std::string_view piece, Findings& findings);
  /// Call this at the end of the file, because a head without rows is complete only then. Fails for
  /// the same reasons as add().
  Result<void> finish(Findings& findings);

  BvhHierarchy hierarchy;
  std::string_view rows() const { return std::string_view(text_).substr(rows_); }
  /// The line on which the rows begin, for messages. Call this before forget_text().
  std::int64_t first_row_line() const;
  /// Frees the memory of the text. Afterwards rows() is empty.
  void forget_text();
  /// The head as the text of a BVH file without rows.
  std::string alone() const;

 private:
  Result<void> parse(Findings& findings);

  std::string name_;  // for messages
  std::string text_;
  std::size_t rows_ = 0;  // position of the first row in text_
};

/// Reads the head of a file. Returns it as the text of a BVH file without rows.
Result<std::string> read_bvh_head(FileSystem& files, const std::string& path);

}  // namespace kinalign
