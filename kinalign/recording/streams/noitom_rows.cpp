// SPDX-License-Identifier: Apache-2.0
// Makes rows of Noitom's frames: poses of the skeleton in the recording's BVH head. Stamps come
// from the frame numbers that the source sends. If frames have no number and came over a
// connection, they are counted, because a connection loses no frame. If they came in datagrams, the
// stamps are the arrivals.
#include "kinalign/protocols/noitom/receiver.h"
#include "kinalign/recording/streams/device_rows.h"
#include "kinalign/recording/streams/noitom_pose.h"
#include "kinalign/recording/streams/numbered_frames.h"

namespace kinalign {

namespace {

/// The part of NumberedFrames and NumberedRows that is specific to Noitom.
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

/// The hierarchy in the BVH head. Fails if neither the recording nor the manifest has a BVH head.
Result<BvhHierarchy> hierarchy_of(const LearnedDevice& learned, const std::string& file) {
  if (learned.skeleton.empty()) {
    return Failure(
        Error{file, 0,
              "a skeleton for stream " + shown(learned.channel.stream) +
                  ", because Noitom's stream contains none: set skeleton = \"a.bvh\" in the "
                  "manifest now, or in lab.toml before recording",
              "none", ErrorKind::no_rows_in_recording});
  }
  // The number of rows and the findings of the BVH file do not matter here.
  std::size_t rows = 0;
  Findings odd;
  return parse_bvh_hierarchy(learned.skeleton, learned.channel.stream + ".bvh", rows, odd);
}

/// The number of values in a frame; 0 if a value is not a number, because NoitomPoser refuses such
/// a frame.
std::uint32_t noitom_shape(const NoitomFrame& frame) {
  const auto row = frame.row();
  return has_sound_values(row) ? static_cast<std::uint32_t>(row.size()) : 0;
}

/// Learns the clock from the frame numbers. Only number, arrival and size of each frame are kept.
class NoitomListener final : public DeviceListener {
 public:
  explicit NoitomListener(std::optional<std::uint64_t> body) : frames_(body) {}

  void take(const RecordedMessage& message) override {
    placed_.clear();
    frames_.take(message, placed_);
    keys_.add(placed_, noitom_shape);
  }

  /// Counts frames at the frame time of the BVH head. If any frame has no number, all stamps are
  /// arrivals.
  Result<void> finish(const DeviceRequest& request, LearnedDevice& learned) override {
    placed_.clear();
    frames_.finish(placed_);
    keys_.add(placed_, noitom_shape);
    append(learned.findings, frames_.findings(request.file.path));
    if (keys_.empty()) {
      return Failure(no_rows_error(NoitomSource::what, request.file.path, learned, frames_.others(),
                                   frames_.findings(request.file.path)));
    }
    // A recording without a BVH head fails here, before the later passes need the head.
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
    // The same test as in NoitomPoser::append(), because a row is made only if the number of values
    // fits.
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
    // The first pass has read the hierarchy without an error, so this call succeeds.
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
