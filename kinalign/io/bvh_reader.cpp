// SPDX-License-Identifier: Apache-2.0
// The rows of a BVH, read in pieces cut anywhere.
#include "kinalign/core/numbers.h"
#include "kinalign/io/bvh.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace kinalign {

namespace {

bool is_blank(char c) { return static_cast<unsigned char>(c) <= ' '; }

/// Judges where lines end against where frames end, in numbers of values.
class RowRule {
 public:
  explicit RowRule(std::size_t row_size) : row_size_(row_size) {}

  /// A line has ended after `values` values in all. False: its frames are shifted for good.
  bool line_end(std::uint64_t values, std::int64_t line) {
    const std::uint64_t in_line = values - line_start_;
    if (in_line == 0) return true;
    const std::uint64_t before = line_start_ % row_size_;
    if (!judged_) {
      judged_ = true;
      strict_ = in_line % row_size_ == 0;
    }
    const bool crosses = before + in_line > row_size_;
    if (strict_ && before != 0 && crosses) return false;
    if (before == 0) {
      shift_line_ = line;
      shift_values_ = in_line;
    }
    line_start_ = values;
    return true;
  }

  // The line from which on frames are shifted, and how many values it holds.
  std::int64_t shift_line() const { return shift_line_; }
  std::uint64_t shift_values() const { return shift_values_; }

 private:
  std::size_t row_size_;
  std::uint64_t line_start_ = 0;  // values before the current line
  bool judged_ = false;           // the first line has been seen
  bool strict_ = false;           // and held whole frames
  std::int64_t shift_line_ = 0;
  std::uint64_t shift_values_ = 0;
};

class BvhReader final : public ClipReader {
 public:
  BvhReader(const BvhOptions& options, std::string name)
      : options_(options), name_(std::move(name)) {}

  Result<void> feed(std::string_view piece, ClipFrames& out) override {
    if (!poser_) {
      constexpr std::size_t longest_head = std::size_t{8} << 20;
      head_ += piece;
      if (!bvh_head_is_whole(head_)) {
        if (head_.size() <= longest_head) return {};
        return Failure(Error{name_, 0, "MOTION within the first 8 MiB", "none"});
      }
      KA_TRY(begin_rows());
      piece = head_;
      piece.remove_prefix(rows_);
    }
    KA_TRY(parse(piece));
    release(out);
    return {};
  }

  Result<void> finish(ClipFrames& out) override {
    if (!poser_) {
      head_ += ' ';
      KA_TRY(begin_rows());
      KA_TRY(parse(std::string_view(head_).substr(rows_)));
    }
    KA_TRY(parse("\n"));  // ends the last number
    release(out);
    judge_end();
    return {};
  }

  const Skeleton* header() const override { return poser_ ? &skeleton_ : nullptr; }

  BvhHierarchy& hierarchy() { return hierarchy_; }
  int decimals() const { return decimals_; }
  void keep_values(std::vector<double>& values) { kept_ = &values; }

 private:
  Result<void> begin_rows() {
    hierarchy_ = KA_TRY(parse_bvh_hierarchy(head_, name_, rows_, findings));
    skeleton_ = skeleton_of(hierarchy_, options_, name_, findings);
    const Findings size = judge_size(skeleton_, options_, name_);
    findings.insert(findings.end(), size.begin(), size.end());
    row_size_ = hierarchy_.row_size();
    if (row_size_ == 0) {
      return Failure(Error{name_, hierarchy_.frames_line, "at least one channel", "none"});
    }
    rule_.emplace(row_size_);
    poser_.emplace(hierarchy_, options_);
    line_ = 1 + std::count(head_.begin(), head_.begin() + static_cast<std::ptrdiff_t>(rows_), '\n');
    return {};
  }

  /// All numbers that end in the piece; the piece's last word waits for its end.
  Result<void> parse(std::string_view piece) {
    if (ended_) return {};
    if (!carry_.empty()) {
      std::size_t end = 0;
      while (end < piece.size() && !is_blank(piece[end])) ++end;
      if (end == piece.size() || carry_.size() + end > longest_word) return hold(piece);
      carry_ += piece.substr(0, end + 1);
      piece.remove_prefix(end + 1);
      const std::string word = std::move(carry_);
      carry_.clear();
      KA_TRY(parse_words(word.data(), word.data() + word.size()));
    }
    std::size_t end = piece.size();
    while (end > 0 && !is_blank(piece[end - 1])) --end;
    KA_TRY(parse_words(piece.data(), piece.data() + end));
    return ended_ ? Result<void>{} : hold(piece.substr(end));
  }

  Result<void> hold(std::string_view word) {
    carry_ += word;
    if (carry_.size() <= longest_word) return {};
    return Failure(wrong_number(carry_));
  }

  Error wrong_number(std::string_view word) const {
    return Error{name_, line_, "a number", "'" + shown(word) + "'"};
  }

  /// [at, end) ends in a blank, so that no number touches `end`.
  Result<void> parse_words(const char* at, const char* end) {
    for (;;) {
      for (; at < end && is_blank(*at); ++at) {
        if (*at != '\n') continue;
        if (!rule_->line_end(frames_ * row_size_ + values_.size(), line_)) {
          return Failure(Error{name_, rule_->shift_line(),
                               fmt::format("{} values in the frame", row_size_),
                               std::to_string(rule_->shift_values())});
        }
        ++line_;
      }
      if (at >= end) return {};
      double value = 0.0;
      const char* behind = parse_number(at, end, value);
      if (behind == nullptr || !is_blank(*behind)) return strange_word(at, end);
      if (kept_ != nullptr) {
        const std::string_view word(at, static_cast<std::size_t>(behind - at));
        decimals_ = std::max(decimals_, decimals_of(word));
      }
      values_.push_back(value);
      at = behind;
    }
  }

  /// Text behind all the frames that the head promised is a finding, a word among them an error.
  Result<void> strange_word(const char* at, const char* end) {
    const char* behind = at;
    while (behind < end && !is_blank(*behind)) ++behind;
    const std::string_view word(at, static_cast<std::size_t>(behind - at));
    const std::uint64_t frames = frames_ + values_.size() / row_size_;
    if (frames < hierarchy_.frames || values_.size() % row_size_ != 0 || hierarchy_.frames == 0) {
      return Failure(wrong_number(word));
    }
    findings.push_back({Severity::warning,
                        Error{name_, line_, "the end of the file", "'" + shown(word) + "'"},
                        "everything from here on was left out", ""});
    ended_ = true;
    return {};
  }

  /// Hands out the complete frames.
  void release(ClipFrames& out) {
    if (!poser_) return;
    const std::size_t frames = values_.size() / row_size_;
    const std::size_t whole = frames * row_size_;
    poser_->append(std::span(values_).first(whole), out);
    if (kept_ != nullptr) {
      kept_->insert(kept_->end(), values_.begin(),
                    values_.begin() + static_cast<std::ptrdiff_t>(whole));
    }
    frames_ += frames;
    values_.erase(values_.begin(), values_.begin() + static_cast<std::ptrdiff_t>(whole));
  }

  void judge_end() {
    if (!values_.empty()) {
      findings.push_back({Severity::warning,
                          Error{name_, line_ - 1, fmt::format("{} values in the frame", row_size_),
                                std::to_string(values_.size())},
                          "the incomplete last frame was dropped", ""});
    }
    if (frames_ != hierarchy_.frames) {
      findings.push_back(
          {Severity::warning,
           Error{name_, hierarchy_.frames_line, fmt::format("{} frames", hierarchy_.frames),
                 std::to_string(frames_)},
           "the frames that are there were read", ""});
    }
  }

  static constexpr std::size_t longest_word = 512;

  BvhOptions options_;
  std::string name_;
  std::string head_;      // until the rows begin
  std::size_t rows_ = 0;  // where they do, in head_
  BvhHierarchy hierarchy_;
  Skeleton skeleton_;
  std::size_t row_size_ = 0;
  std::optional<RowRule> rule_;
  std::optional<BvhPoser> poser_;
  std::string carry_;           // a word cut by the end of a piece
  std::vector<double> values_;  // of frames not yet handed out
  std::uint64_t frames_ = 0;    // handed out
  std::int64_t line_ = 1;
  bool ended_ = false;  // by strange text
  std::vector<double>* kept_ = nullptr;
  int decimals_ = 0;
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
