// SPDX-License-Identifier: Apache-2.0
// A BVH in pieces: its head is gathered until it is whole, then rows become poses.
#include "kinalign/io/bvh_head.h"
#include "kinalign/io/bvh_rows.h"

#include <fmt/format.h>

#include <optional>

namespace kinalign {

namespace {

class BvhReader final : public ClipReader {
 public:
  BvhReader(const BvhOptions& options, std::string name)
      : options_(options), name_(std::move(name)), head_(name_) {}

  Result<void> feed(std::string_view piece, ClipFrames& out) override {
    if (rows_) {
      KA_TRY(rows_->feed(piece, findings));
    } else {
      if (!KA_TRY(head_.add(piece, findings))) return {};
      KA_TRY(begin_rows());
    }
    release(out);
    return {};
  }

  Result<void> finish(ClipFrames& out) override {
    if (!rows_) {
      KA_TRY(head_.finish(findings));
      KA_TRY(begin_rows());
    }
    KA_TRY(rows_->finish(findings));
    release(out);
    if (rows_->frames_read() != head_.hierarchy.frames) {
      findings.push_back({Severity::warning,
                          Error{name_, head_.hierarchy.frames_line,
                                fmt::format("{} frames", head_.hierarchy.frames),
                                std::to_string(rows_->frames_read())},
                          "the frames that are there were read", ""});
    }
    return {};
  }

  const Skeleton* header() const override { return rows_ ? &skeleton_ : nullptr; }

  BvhHierarchy& hierarchy() { return head_.hierarchy; }
  int decimals() const { return rows_->decimals(); }
  void keep_values(std::vector<double>& values) { kept_ = &values; }

 private:
  /// The head is whole: what stands behind it are rows.
  Result<void> begin_rows() {
    skeleton_ = skeleton_of(head_.hierarchy, options_, name_, findings);
    const Findings size = judge_size(skeleton_, options_, name_);
    findings.insert(findings.end(), size.begin(), size.end());
    const std::size_t row_size = head_.hierarchy.row_size();
    if (row_size == 0) {
      return Failure(Error{name_, head_.hierarchy.frames_line, "at least one channel", "none"});
    }
    poser_.emplace(head_.hierarchy, options_);
    rows_.emplace(BvhRowsHead{name_, row_size, head_.hierarchy.frames, head_.first_row_line()});
    rows_->count_decimals = kept_ != nullptr;
    KA_TRY(rows_->feed(head_.rows(), findings));
    head_.forget_text();
    return {};
  }

  /// Hands out the complete frames.
  void release(ClipFrames& out) {
    const auto values = rows_->frames();
    poser_->append(values, out);
    if (kept_ != nullptr) kept_->insert(kept_->end(), values.begin(), values.end());
    rows_->drop_frames();
  }

  BvhOptions options_;
  std::string name_;
  BvhHead head_;
  Skeleton skeleton_;
  std::optional<BvhRows> rows_;
  std::optional<BvhPoser> poser_;
  std::vector<double>* kept_ = nullptr;
};

}  // namespace

std::unique_ptr<ClipReader> make_bvh_reader(const BvhOptions& options, std::string name) {
  return std::make_unique<BvhReader>(options, std::move(name));
}

Result<BvhFile> read_bvh(std::string_view text, std::string_view name, const BvhOptions& options) {
  BvhFile file;
  BvhReader reader(options, std::string(name));
  reader.keep_values(file.values);
  KA_TRY(reader.feed(text, file.clip.frames));
  KA_TRY(reader.finish(file.clip.frames));
  file.clip.skeleton = *reader.header();
  file.hierarchy = std::move(reader.hierarchy());
  file.decimals = reader.decimals();
  file.findings = std::move(reader.findings);
  return file;
}

}  // namespace kinalign
