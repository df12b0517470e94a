// SPDX-License-Identifier: Apache-2.0
// Noitom's frames: poses of the skeleton that the recording has a header of, stamped by the number
// that the source gives its frames; over a connection, which loses none, by their count; in
// datagrams without a number by arrival.
#include "kinalign/protocols/noitom/receiver.h"
#include "kinalign/recording/streams/device_rows.h"
#include "kinalign/recording/streams/noitom_pose.h"
#include "kinalign/recording/streams/numbered_frames.h"

namespace kinalign {

namespace {

struct NoitomSource {
  static constexpr std::string_view what = "frames of Noitom's stream";
  static constexpr std::string_view frames = "frames";
  using Decoder = NoitomReceiver;
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
                         "none", ErrorKind::no_rows_in_recording});
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
    count_placed();
  }

  Result<void> finish(HeardDevice& heard) override {
    placed_.clear();
    frames_.finish(placed_);
    count_placed();
    append(heard.findings, frames_.findings(wish_.file.path));
    if (counted_.empty() && !unnumbered_) {
      return Failure(nothing_of(NoitomSource::what, wish_.file.path, heard, frames_.others()));
    }
    const BvhHierarchy hierarchy = KA_TRY(hierarchy_of(heard, wish_.file.path));
    heard.step_ns = 1e9 * hierarchy.frame_seconds;
    if (unnumbered_) {
      stamp_by_arrival(wish_.file.path, heard);
    } else {
      count_clock(counted_, heard.step_ns, wish_, heard);
    }
    return {};
  }

 private:
  void count_placed() {
    for (const auto& one : placed_) {
      if (one.place) counted_.push_back(*one.place);
      unnumbered_ |= !one.place;
    }
  }

  DeviceWish wish_;
  NoitomFrames frames_;
  std::vector<NoitomFrames::Placed> placed_;
  std::vector<CountedFrame> counted_;
  bool unnumbered_ = false;
};

class NoitomRows final : public NumberedRows<NoitomSource, ClipFrames> {
 public:
  NoitomRows(const DeviceWish& wish, const std::shared_ptr<const HeardDevice>& heard)
      : NumberedRows(wish, heard) {
    const auto hierarchy = hierarchy_of(*heard, wish.file.path);  // listening has read it before
    if (!hierarchy) return;
    const BvhOptions options = bvh_options(wish.options);
    const std::string name = heard->channel.stream + ".bvh";
    skeleton_ = skeleton_of(*hierarchy, options, name, findings);
    poser_.emplace(*hierarchy, options, name);
    kinalign::append(findings, poser_->findings());
    kinalign::append(findings, judge_size(*hierarchy, skeleton_, {}, options, name));
  }
  const Skeleton* header() const override { return &skeleton_; }

 private:
  Result<void> append(const NoitomFrame& frame, Time stamp, ClipFrames& out) override {
    return poser_->append(frame, stamp, out);
  }

  Skeleton skeleton_;
  std::optional<NoitomPoser> poser_;
};

}  // namespace

DeviceProtocol noitom_protocol() { return device_protocol<NoitomListener, NoitomRows>(); }

}  // namespace kinalign
