// SPDX-License-Identifier: Apache-2.0
// A BVH in pieces: rows become poses.
#include "kinalign/formats/bvh/values.h"

#include <optional>

namespace kinalign {

namespace {

class BvhReader final : public ClipReader {
 public:
  BvhReader(const BvhOptions& options, const std::string& name)
      : options_(options),
        name_(name),
        values_(name, [this](const BvhHierarchy& h) { begin(h); }) {}
  BvhReader(const BvhReader&) = delete;  // values_ knows where it lies
  BvhReader& operator=(const BvhReader&) = delete;
  ~BvhReader() override = default;

  Result<void> feed(std::string_view piece, ClipFrames& out) override {
    KA_TRY(values_.feed(piece, findings));
    release(out);
    return {};
  }

  Result<void> finish(ClipFrames& out) override {
    KA_TRY(values_.finish(findings));
    release(out);
    if (!judged_) judge({});
    return {};
  }

  const Skeleton* header() const override { return values_.has_rows() ? &skeleton_ : nullptr; }

  BvhHierarchy& hierarchy() { return values_.hierarchy(); }
  int decimals() const { return values_.decimals(); }
  void keep_values(std::vector<double>& values) {
    kept_ = &values;
    values_.count_decimals = true;
  }

 private:
  void begin(const BvhHierarchy& hierarchy) {
    skeleton_ = skeleton_of(hierarchy, options_, name_, findings);
    poser_.emplace(hierarchy, options_);
  }

  /// Hands out the complete frames.
  void release(ClipFrames& out) {
    if (!values_.has_rows()) return;
    const auto values = values_.frames();
    poser_->append(values, out);
    if (!judged_ && !values.empty()) judge(values);
    if (kept_ != nullptr) kept_->insert(kept_->end(), values.begin(), values.end());
    values_.drop_frames();
  }

  void judge(std::span<const double> rows) {
    append(findings, judge_size(values_.hierarchy(), skeleton_, rows, options_, name_));
    judged_ = true;
  }

  BvhOptions options_;
  std::string name_;
  BvhValues values_;
  bool judged_ = false;  // size and axis
  Skeleton skeleton_;
  std::optional<BvhPoser> poser_;
  std::vector<double>* kept_ = nullptr;
};

}  // namespace

std::unique_ptr<ClipReader> make_bvh_reader(const BvhOptions& options, const std::string& name) {
  return std::make_unique<BvhReader>(options, name);
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
