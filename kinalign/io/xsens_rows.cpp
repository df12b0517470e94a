// SPDX-License-Identifier: Apache-2.0
// Poses of Xsens MVN's stream, stamped by its sample counter.
#include "kinalign/io/counted_clock.h"
#include "kinalign/io/device_rows.h"
#include "kinalign/io/little_endian_reader.h"
#include "kinalign/io/xsens_pose.h"
#include "kinalign/io/xsens_stream.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

struct PlacedPose {
  XsensPose pose;
  CountedFrame place;
};

/// One character's poses, without those that came twice.
class XsensPoses {
 public:
  XsensPoses(std::optional<std::uint64_t> character, std::string file)
      : character_(character), file_(std::move(file)) {}

  void take(const RecordedMessage& message, std::vector<PlacedPose>& out) {
    if (channel_ != message.channel_id) {  // another connection, or another sender's life
      report();
      decoder_ = {};
      numbers_.begin_life();
      channel_ = message.channel_id;
    }
    arrivals_.clear();
    decoder_.feed(octets(message.payload), arrivals_);
    for (XsensArrival& one : arrivals_) {
      auto* pose = std::get_if<XsensPose>(&one.sample.body);
      if (pose == nullptr || one.order == Order::duplicate) continue;
      if (!character_) character_ = one.sample.character;
      if (one.sample.character != *character_) continue;
      out.push_back({std::move(*pose), numbers_.place(one.sample.counter, message.arrival)});
    }
  }
  void report() { append(findings, decoder_.findings(file_)); }

  Findings findings;

 private:
  std::optional<std::uint64_t> character_;
  std::string file_;
  std::optional<std::uint16_t> channel_;
  XsensDecoder decoder_;
  std::vector<XsensArrival> arrivals_;
  FrameNumbers numbers_;
};

class XsensListener final : public DeviceListener {
 public:
  explicit XsensListener(const DeviceWish& wish) : wish_(wish), poses_(wish.body, wish.file.path) {}

  void take(const RecordedMessage& message) override {
    placed_.clear();
    poses_.take(message, placed_);
    for (const PlacedPose& one : placed_) counted_.push_back(one.place);
  }

  Result<void> finish(HeardDevice& heard) override {
    poses_.report();
    append(heard.findings, poses_.findings);
    if (counted_.empty()) {
      return Failure(Error{wish_.file.path, 0, "poses (type 02) of Xsens MVN", "none"});
    }
    const double rate = wish_.options.rate_hz;
    CountedClock clock = counted_clock(counted_, rate > 0.0 ? 1e9 / rate : 0.0,
                                       heard.utc_minus_host, wish_.file.path);
    append(heard.findings, clock.findings);
    heard.step_ns = clock.step_ns;
    heard.clock = std::move(clock.clock);
    return {};
  }

 private:
  DeviceWish wish_;
  XsensPoses poses_;
  std::vector<PlacedPose> placed_;
  std::vector<CountedFrame> counted_;
};

class XsensRows final : public DeviceRows<ClipFrames> {
 public:
  XsensRows(const DeviceWish& wish, std::shared_ptr<const HeardDevice> heard)
      : heard_(std::move(heard)), poses_(wish.body, wish.file.path), poser_(wish.file.path) {}

  Result<void> take(const RecordedMessage& message, ClipFrames& out) override {
    placed_.clear();
    poses_.take(message, placed_);
    for (const PlacedPose& one : placed_) {
      const auto stamp = stamp_of(heard_->clock, one.place.life,
                                  counter_of(one.place, heard_->step_ns), one.place.arrival);
      if (!stamp) continue;
      auto posed = poser_.append(one.pose, *stamp, out);
      if (posed) continue;
      if (!misfit_) misfit_ = std::move(posed).error();
      ++misfits_;
    }
    return {};
  }

  Result<void> finish(ClipFrames&) override {
    if (poser_.skeleton() == nullptr) {
      return Failure(misfit_.value_or(Error{"", 0, "a pose of 23 segments", "none"}));
    }
    append(findings, poser_.findings);
    if (misfit_) {
      findings.push_back({Severity::warning, *misfit_,
                          fmt::format("{} poses of that kind were left out", misfits_), ""});
    }
    return {};
  }

  const Skeleton* header() const override { return poser_.skeleton(); }

 private:
  std::shared_ptr<const HeardDevice> heard_;
  XsensPoses poses_;
  XsensPoser poser_;
  std::vector<PlacedPose> placed_;
  std::optional<Error> misfit_;
  std::uint64_t misfits_ = 0;
};

}  // namespace

DeviceProtocol xsens_protocol() { return device_protocol<XsensListener, XsensRows>("xsens"); }

}  // namespace kinalign
