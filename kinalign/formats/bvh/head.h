// SPDX-License-Identifier: Apache-2.0
// What stands above a BVH's rows, gathered from pieces until it is whole.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/formats/bvh/bvh.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace kinalign {

/// Everything up to the blank separates words: tabs, returns and other control characters too.
inline bool is_blank(char c) { return static_cast<unsigned char>(c) <= ' '; }

class BvhHead {
 public:
  explicit BvhHead(std::string name) : name_(std::move(name)) {}

  /// True once the head is whole: then `hierarchy` is read and rows() is what came behind it.
  /// Fails where the hierarchy can't be understood or does not end within 8 MiB.
  Result<bool> add(std::string_view piece, Findings& findings);
  /// The file has ended: a head that nothing follows is whole now. Fails as add does.
  Result<void> finish(Findings& findings);

  BvhHierarchy hierarchy;
  std::string_view rows() const { return std::string_view(text_).substr(rows_); }
  std::int64_t first_row_line() const;
  void forget_text();
  /// The head as a BVH of its own, without rows.
  std::string alone() const;

 private:
  Result<void> parse(Findings& findings);

  std::string name_;  // for messages
  std::string text_;
  std::size_t rows_ = 0;  // where they begin
};

/// The head of a file as a BVH of its own, without rows.
Result<std::string> read_bvh_head(FileSystem& files, const std::string& path);

}  // namespace kinalign
