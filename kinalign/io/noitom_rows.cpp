// SPDX-License-Identifier: Apache-2.0
// Noitom's frames: poses of the skeleton that the recording has a header of, stamped by the number
// that the source gives its frames; over a connection, which loses none, by their count; in
// datagrams without a number by arrival.
#include "kinalign/io/device_rows.h"
#include "kinalign/io/noitom_pose.h"
#include "kinalign/io/noitom_stream.h"
#include "kinalign/io/numbered_frames.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

struct NoitomSource {
  using Decoder = NoitomDecoder;
  using Arrival = NoitomArrival;
  using Frame = NoitomFrame;
  static Frame* frame(Arrival& arrival) { return &arrival.frame; }
  static std::uint64_t body(const Arrival& arrival) { return arrival.frame.avatar; }
  static std::optional<std::uint32_t> number(const Arrival& a) { return a.frame.frame_index; }
};
using NoitomFrames = NumberedFrames<NoitomSource>;

Result<BvhHierarchy> hierarchy_of(const HeardDevice& heard, const std::string& file) {
  if (heard.skeleton.empty()) {
    return Failure(Error{file, 0,
                         "of stream " + shown(heard.channel.stream) +
                             " the skeleton, which Noitom's stream lacks: skeleton = \"a.bvh\" in "
                             "lab.toml while recording, or now in the manifest",
                         "none"});
  }
  std::size_t rows = 0;
  Findings odd;
  return parse_bvh_hierarchy(heard.skeleton, heard.channel.stream + ".bvh", rows, odd);
}

class NoitomListener final : public DeviceListener {
 public:
  explicit NoitomListener(const DeviceWish& wish) : wish_(wish), frames_(wish.body) {}

  void take(const RecordedMessage& message) override {
    placed_.clear();
    frames_.take(message, placed_);
    for (const auto& one : placed_) {
      if (one.place) counted_.push_back(*one.place);
      unnumbered_ |= !one.place;
    }
  }

  Result<void> finish(HeardDevice& heard) override {
    append(heard.findings, frames_.findings(wish_.file.path));
    const BvhHierarchy hierarchy = KA_TRY(hierarchy_of(heard, wish_.file.path));
    heard.by_arrival = unnumbered_;
    if (unnumbered_) return {};
    count_clock(counted_, 1e9 * hierarchy.frame_seconds, wish_, heard);
    return {};
  }

 private:
  DeviceWish wish_;
  NoitomFrames frames_;
  std::vector<NoitomFrames::Placed> placed_;
  std::vector<CountedFrame> counted_;
  bool unnumbered_ = false;
};

class NoitomRows final : public DeviceRows<ClipFrames> {
 public:
  NoitomRows(const DeviceWish& wish, std::shared_ptr<const HeardDevice> heard)
      : DeviceRows(wish.file.path), heard_(std::move(heard)), frames_(wish.body) {
    const auto hierarchy = hierarchy_of(*heard_, wish.file.path);  // listening has read it before
    if (!hierarchy) return;
    const BvhOptions options = bvh_options(wish.options);
    const std::string name = heard_->channel.stream + ".bvh";
    skeleton_ = skeleton_of(*hierarchy, options, name, findings);
    poser_.emplace(*hierarchy, options, name);
    append(findings, poser_->findings());
    append(findings, judge_size(*hierarchy, skeleton_, {}, options, name));
  }

  Result<void> take(const RecordedMessage& message, ClipFrames& out) override {
    placed_.clear();
    frames_.take(message, placed_);
    for (const auto& one : placed_) {
      const auto stamp = stamp_of(*heard_, one);
      if (!stamp) {
        ++unknown_;
        continue;
      }
      auto posed = poser_->append(one.frame, *stamp, out);
      if (posed) {
        ++posed_;
        continue;
      }
      if (!misfit_) misfit_ = std::move(posed).error();
      ++misfits_;
    }
    return {};
  }

  Result<void> finish(ClipFrames&) override {
    if (misfit_ && posed_ == 0) return Failure(*misfit_);
    if (misfit_) {
      findings.push_back({Severity::warning, *misfit_,
                          fmt::format("{} frames of that kind were left out", misfits_), ""});
    }
    tell(unknown_, "frames whose clock is known", "others", "they were left out");
    return {};
  }

  const Skeleton* header() const override { return &skeleton_; }

 private:
  std::shared_ptr<const HeardDevice> heard_;
  NoitomFrames frames_;
  Skeleton skeleton_;
  std::optional<NoitomPoser> poser_;
  std::vector<NoitomFrames::Placed> placed_;
  std::optional<Error> misfit_;
  std::uint64_t posed_ = 0, misfits_ = 0, unknown_ = 0;
};

}  // namespace

DeviceProtocol noitom_protocol() { return device_protocol<NoitomListener, NoitomRows>("noitom"); }

}  // namespace kinalign
