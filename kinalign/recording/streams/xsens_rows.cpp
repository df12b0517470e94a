// SPDX-License-Identifier: Apache-2.0
// Makes rows of Xsens MVN's stream: poses, or the inertial samples of the trackers. Stamps come
// from the sample counter.
#include "kinalign/protocols/xsens/stream.h"
#include "kinalign/recording/streams/device_rows.h"
#include "kinalign/recording/streams/numbered_frames.h"
#include "kinalign/recording/streams/xsens_pose.h"

namespace kinalign {

namespace {

template <class Items>
constexpr std::string_view meaning = "poses (type 02) of Xsens MVN";
template <>
constexpr std::string_view meaning<XsensTrackers> = "trackers (type 23) of Xsens MVN";

/// The part of NumberedFrames and NumberedRows that is specific to Xsens. `Items` is XsensPose or
/// XsensTrackers; both come in the same stream.
template <class Items>
struct XsensSource {
  static constexpr std::string_view what = meaning<Items>;
  static constexpr std::string_view frames = "samples";
  using Decoder = XsensDecoder;
  using Arrival = XsensArrival;
  using Frame = Items;
  static Frame* frame(Arrival& arrival) { return std::get_if<Items>(&arrival.sample.body); }
  static std::uint64_t body(const Arrival& arrival) { return arrival.sample.character; }
};
template <class Items>
using XsensFrames = NumberedFrames<XsensSource<Items>>;

/// Learns the clock from the sample counter. The shape of each sample later decides whether the
/// sample gives a row.
template <class Items>
class XsensListener final : public DeviceListener {
 public:
  explicit XsensListener(std::optional<std::uint64_t> character) : frames_(character) {}

  void take(const RecordedMessage& message) override {
    placed_.clear();
    frames_.take(message, placed_);
    keys_.add(placed_, [](const Items& items) { return xsens_shape(items); });
  }

  Result<void> finish(const DeviceRequest& request, LearnedDevice& learned) override {
    append(learned.findings, frames_.findings(request.file.path));
    if (keys_.empty()) {
      return Failure(no_rows_error(meaning<Items>, request.file.path, learned, frames_.others(),
                                   frames_.findings(request.file.path)));
    }
    count_clock(keys_.counted(), 0.0, request, learned);
    return {};
  }

  void stamp_rows(const LearnedDevice& learned, const TakeStamp& take) const override {
    keys_.stamp_rows(learned, XsensFits<Items>(), take);
  }

 private:
  XsensFrames<Items> frames_;
  std::vector<PlacedFrame<Items>> placed_;
  FrameKeys keys_;
};

/// Makes rows of poses. The poser finds the skeleton and the unit of length in the first pose.
class XsensPoseRows final : public NumberedRows<XsensSource<XsensPose>, ClipFrames> {
 public:
  XsensPoseRows(const DeviceRequest& request, std::shared_ptr<const LearnedDevice> learned)
      : NumberedRows(request, std::move(learned)), poser_(request.file.path) {}
  const Skeleton* header() const override { return poser_.skeleton(); }

 private:
  Result<void> append(const XsensPose& pose, Time stamp, ClipFrames& out) override {
    return poser_.append(pose, stamp, out);
  }
  Findings further_findings() const override { return poser_.findings; }

  XsensPoser poser_;
};

/// Makes rows of trackers. The header is known after the first sample.
class XsensTrackerRows final : public NumberedRows<XsensSource<XsensTrackers>, ImuSamples> {
 public:
  XsensTrackerRows(const DeviceRequest& request, std::shared_ptr<const LearnedDevice> learned)
      : NumberedRows(request, std::move(learned)), nodes_(request.file.path) {}
  const ImuHeader* header() const override { return nodes_.header(); }

 private:
  Result<void> append(const XsensTrackers& trackers, Time stamp, ImuSamples& out) override {
    return nodes_.append(trackers, stamp, out);
  }

  XsensNodes nodes_;
};

}  // namespace

DeviceProtocol xsens_protocol() {
  return device_protocol<XsensListener<XsensPose>, XsensPoseRows>();
}

DeviceProtocol xsens_tracker_protocol() {
  return device_protocol<XsensListener<XsensTrackers>, XsensTrackerRows>();
}

}  // namespace kinalign
