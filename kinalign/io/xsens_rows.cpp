// SPDX-License-Identifier: Apache-2.0
// Poses of Xsens MVN's stream, stamped by its sample counter.
#include "kinalign/io/device_rows.h"
#include "kinalign/io/numbered_frames.h"
#include "kinalign/io/xsens_pose.h"
#include "kinalign/io/xsens_stream.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

struct XsensSource {
  using Decoder = XsensDecoder;
  using Arrival = XsensArrival;
  using Frame = XsensPose;
  static Frame* frame(Arrival& arrival) { return std::get_if<XsensPose>(&arrival.sample.body); }
  static std::uint64_t body(const Arrival& arrival) { return arrival.sample.character; }
  static std::optional<std::uint32_t> number(const Arrival& a) { return a.sample.counter; }
};
using XsensPoses = NumberedFrames<XsensSource>;

class XsensListener final : public DeviceListener {
 public:
  explicit XsensListener(const DeviceWish& wish) : wish_(wish), poses_(wish.body) {}

  void take(const RecordedMessage& message) override {
    placed_.clear();
    poses_.take(message, placed_);
    for (const auto& one : placed_) counted_.push_back(*one.place);
  }

  Result<void> finish(HeardDevice& heard) override {
    append(heard.findings, poses_.findings(wish_.file.path));
    if (counted_.empty()) {
      return Failure(Error{wish_.file.path, 0, "poses (type 02) of Xsens MVN", "none"});
    }
    count_clock(counted_, 0.0, wish_, heard);
    return {};
  }

 private:
  DeviceWish wish_;
  XsensPoses poses_;
  std::vector<XsensPoses::Placed> placed_;
  std::vector<CountedFrame> counted_;
};

class XsensRows final : public DeviceRows<ClipFrames> {
 public:
  XsensRows(const DeviceWish& wish, std::shared_ptr<const HeardDevice> heard)
      : DeviceRows(wish.file.path),
        heard_(std::move(heard)),
        poses_(wish.body),
        poser_(wish.file.path) {}

  Result<void> take(const RecordedMessage& message, ClipFrames& out) override {
    placed_.clear();
    poses_.take(message, placed_);
    for (const auto& one : placed_) {
      const auto stamp = stamp_of(*heard_, one);
      if (!stamp) {
        ++unknown_;
        continue;
      }
      auto posed = poser_.append(one.frame, *stamp, out);
      if (posed) continue;
      if (!misfit_) misfit_ = std::move(posed).error();
      ++misfits_;
    }
    return {};
  }

  Result<void> finish(ClipFrames&) override {
    if (poser_.skeleton() == nullptr) {
      return Failure(misfit_.value_or(Error{file(), 0, "a pose of 23 segments", "none"}));
    }
    append(findings, poser_.findings);
    if (misfit_) {
      findings.push_back({Severity::warning, *misfit_,
                          fmt::format("{} poses of that kind were left out", misfits_), ""});
    }
    tell(unknown_, "poses whose clock is known", "others", "they were left out");
    return {};
  }

  const Skeleton* header() const override { return poser_.skeleton(); }

 private:
  std::shared_ptr<const HeardDevice> heard_;
  XsensPoses poses_;
  XsensPoser poser_;
  std::vector<XsensPoses::Placed> placed_;
  std::optional<Error> misfit_;
  std::uint64_t misfits_ = 0, unknown_ = 0;
};

}  // namespace

DeviceProtocol xsens_protocol() { return device_protocol<XsensListener, XsensRows>("xsens"); }

}  // namespace kinalign
