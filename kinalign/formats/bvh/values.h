// SPDX-License-Identifier: Apache-2.0
// A BVH's hierarchy and its rows as they are written, from pieces cut anywhere.
#pragma once

#include "kinalign/formats/bvh/head.h"
#include "kinalign/formats/bvh/rows.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace kinalign {

class BvhValues {
 public:
  /// `on_head` is called once, with the hierarchy, before the first row is looked at.
  using OnHead = std::function<void(const BvhHierarchy&)>;

  explicit BvhValues(std::string name, OnHead on_head = {})
      : name_(std::move(name)), on_head_(std::move(on_head)), head_(name_) {}

  Result<void> feed(std::string_view piece, Findings& findings);
  /// The file has ended; another number of frames than promised is a finding.
  Result<void> finish(Findings& findings);

  bool has_rows() const { return rows_.has_value(); }
  BvhHierarchy& hierarchy() { return head_.hierarchy; }
  /// The complete frames not yet dropped, values [n,C].
  std::span<const double> frames() const {
    return rows_ ? rows_->frames() : std::span<const double>();
  }
  void drop_frames() {
    if (rows_) rows_->drop_frames();
  }
  std::uint64_t frames_read() const { return rows_ ? rows_->frames_read() : 0; }
  int decimals() const { return rows_ ? rows_->decimals() : 0; }  // with count_decimals
  bool count_decimals = false;

 private:
  Result<void> begin_rows(Findings& findings);

  std::string name_;
  OnHead on_head_;
  BvhHead head_;
  std::optional<BvhRows> rows_;
};

}  // namespace kinalign
