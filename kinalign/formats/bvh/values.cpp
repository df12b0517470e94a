// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/bvh/values.h"

#include <fmt/format.h>

namespace kinalign {

Result<void> BvhValues::feed(std::string_view piece, Findings& findings) {
  if (rows_) return rows_->feed(piece, findings);
  return KA_TRY(head_.add(piece, findings)) ? begin_rows(findings) : Result<void>();
}

Result<void> BvhValues::finish(Findings& findings) {
  if (!rows_) {
    KA_TRY(head_.finish(findings));
    KA_TRY(begin_rows(findings));
  }
  KA_TRY(rows_->finish(findings));
  if (frames_read() == head_.hierarchy.frames) return {};
  findings.push_back(
      {Severity::warning,
       Error{name_, head_.hierarchy.frames_line, fmt::format("{} frames", head_.hierarchy.frames),
             std::to_string(frames_read())},
       "the frames that are there were read", ""});
  return {};
}

/// The head is whole: what stands behind it are rows.
Result<void> BvhValues::begin_rows(Findings& findings) {
  const BvhHierarchy& hierarchy = head_.hierarchy;
  if (on_head_) on_head_(hierarchy);
  const std::size_t row_size = hierarchy.row_size();
  if (row_size == 0) {
    return Failure(Error{name_, hierarchy.frames_line, "at least one channel", "none"});
  }
  rows_.emplace(BvhRowsHead{name_, row_size, hierarchy.frames, head_.first_row_line()});
  rows_->count_decimals = count_decimals;
  KA_TRY(rows_->feed(head_.rows(), findings));
  head_.forget_text();
  return {};
}

}  // namespace kinalign
