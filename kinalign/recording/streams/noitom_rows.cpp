// SPDX-License-Identifier: Apache-2.0
// Rows of Noitom's frames: poses of the skeleton whose BVH header the recording contains. Stamps
// come from the frame number that the source sends. Over a connection, which loses no frame, frames
// without a number are counted. In datagrams without a number, stamps are arrivals.
#include "kinalign/protocols/noitom/receiver.h"
#include "kinalign/recording/streams/device_rows.h"
#include "kinalign/recording/streams/noitom_pose.h"
#include "kinalign/recording/streams/numbered_frames.h"

namespace kinalign {

namespace {

/// The parts of NumberedFrames and NumberedRows that differ between sources, for Noitom.
struct NoitomSource {
  static constexpr std::string_view what = "frames of Noitom's stream";
  static constexpr std::string_view frames = "frames";
  using Decoder = NoitomReceiver;
  using Arrival = NoitomArrival;
  using Frame = NoitomFrame;
  static Frame* frame(Arrival& arrival) { return &arrival.frame; }
  static std::uint64_t body(const Arrival& arrival) { return arrival.frame.avatar; }
};
using NoitomFrames = NumberedFrames<NoitomSource>;

/// The hierarchy of the BVH header. Fails if neither recording nor manifest has one.
Result<BvhHierarchy> hierarchy_of(const LearnedDevice& learned, const std::string& file) {
  if (learned.skeleton.empty()) {
    return Failure(
        Error{file, 0,
              "a skeleton for stream " + shown(learned.channel.stream) +
                  ", because Noitom's stream contains none: set skeleton = \"a.bvh\" in the "
                  "manifest now, or in lab.toml before recording",
              "none", ErrorKind::no_rows_in_recording});
  }
  // The number of rows and the findings of the header's own file do not matter here.
  std::size_t rows = 0;
  Findings odd;
  return parse_bvh_hierarchy(learned.skeleton, learned.channel.stream + ".bvh", rows, odd);
}

/// The number of values in a frame; 0 if one is not a number, since NoitomPoser refuses such a
/// frame.
std::uint32_t noitom_shape(const NoitomFrame& frame) {
  const auto row = frame.row();
  return has_sound_values(row) ? static_cast<std::uint32_t>(row.size()) : 0;
}

/// Learns the clock from the numbers of frames. Only a frame's number, arrival and size are kept.
class NoitomListener final : public DeviceListener {
 public:
  explicit NoitomListener(std::optional<std::uint64_t> body) : frames_(body) {}

  void take(const RecordedMessage& message) override {
    placed_.clear();
    frames_.take(message, placed_);
    keys_.add(placed_, noitom_shape);
  }

  /// Counts frames at the header's frame time. If any frame has no number, all stamps are arrivals.
  Result<void> finish(const DeviceRequest& request, LearnedDevice& learned) override {
    placed_.clear();
    frames_.finish(placed_);
    keys_.add(placed_, noitom_shape);
    append(learned.findings, frames_.findings(request.file.path));
    if (keys_.empty()) {
      return Failure(
          no_rows_error(NoitomSource::what, request.file.path, learned, frames_.others()));
    }
    // A recording without a header fails here, before the later passes need it.
    const BvhHierarchy hierarchy = KA_TRY(hierarchy_of(learned, request.file.path));
    row_size_ = hierarchy.row_size();
    learned.step_ns = 1e9 * hierarchy.frame_seconds;
    if (keys_.any_unnumbered()) {
      stamp_by_arrival(request.file.path, learned);
    } else {
      count_clock(keys_.counted(), learned.step_ns, request, learned);
    }
    return {};
  }

  void stamp_rows(const LearnedDevice& learned, const TakeStamp& take) const override {
    // The same test as in NoitomPoser::append, by the frame's number of values.
    keys_.stamp_rows(
        learned, [this](std::uint32_t values) { return values == row_size_; }, take);
  }

 private:
  NoitomFrames frames_;
  std::vector<NoitomFrames::Placed> placed_;
  FrameKeys keys_;
  std::size_t row_size_ = 0;
};

class NoitomRows final : public NumberedRows<NoitomSource, ClipFrames> {
 public:
  NoitomRows(const DeviceRequest& request, const std::shared_ptr<const LearnedDevice>& learned)
      : NumberedRows(request, learned) {
    // the first pass has read it without an error
    const auto hierarchy = hierarchy_of(*learned, request.file.path);
    if (!hierarchy) return;
    const BvhOptions options = bvh_options(request.options);
    const std::string name = learned->channel.stream + ".bvh";
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
