// SPDX-License-Identifier: Apache-2.0
// Noitom's frames: poses of the skeleton that the recording has a header of, stamped by the number
// that the source gives its frames; over a connection, which loses none, by their count; in
// datagrams without a number by arrival.
#include "kinalign/io/counted_clock.h"
#include "kinalign/io/device_rows.h"
#include "kinalign/io/little_endian_reader.h"
#include "kinalign/io/noitom_pose.h"
#include "kinalign/io/noitom_stream.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

struct PlacedFrame {
  NoitomFrame frame;
  std::optional<CountedFrame> place;  // absent: nobody numbers it
  HostTime arrival{};
};

/// One avatar's frames, without those that came twice.
class NoitomFrames {
 public:
  NoitomFrames(std::optional<std::uint64_t> avatar, std::string file)
      : avatar_(avatar), file_(std::move(file)) {}

  void take(const RecordedMessage& message, std::vector<PlacedFrame>& out) {
    if (channel_ != message.channel_id) {  // another connection, or another sender's life
      report();
      decoder_ = {};
      numbers_.begin_life();
      channel_ = message.channel_id;
    }
    const bool lossless = message.channel->transport != "udp";
    arrivals_.clear();
    decoder_.feed(octets(message.payload), arrivals_);
    for (NoitomArrival& one : arrivals_) {
      if (!avatar_) avatar_ = one.frame.avatar;
      if (one.frame.avatar != *avatar_ || one.order == Order::duplicate) continue;
      PlacedFrame placed{std::move(one.frame), {}, message.arrival};
      if (placed.frame.frame_index) {
        placed.place = numbers_.place(*placed.frame.frame_index, message.arrival);
      } else if (lossless) {
        placed.place = numbers_.place(counted_++, message.arrival);
      }
      out.push_back(std::move(placed));
    }
  }
  void report() { append(findings, decoder_.findings(file_)); }

  Findings findings;

 private:
  std::optional<std::uint64_t> avatar_;
  std::string file_;
  std::optional<std::uint16_t> channel_;
  NoitomDecoder decoder_;
  std::vector<NoitomArrival> arrivals_;
  FrameNumbers numbers_;
  std::uint32_t counted_ = 0;
};

Result<BvhHierarchy> hierarchy_of(const HeardDevice& heard, const std::string& file) {
  if (heard.skeleton.empty()) {
    return Failure(Error{file, 0,
                         "the header of the skeleton, which the stream lacks: an attachment " +
                             heard.channel.stream + ".bvh (skeleton in lab.toml)",
                         "none"});
  }
  std::size_t rows = 0;
  Findings odd;
  return parse_bvh_hierarchy(heard.skeleton, heard.channel.stream + ".bvh", rows, odd);
}

class NoitomListener final : public DeviceListener {
 public:
  explicit NoitomListener(const DeviceWish& wish)
      : wish_(wish), frames_(wish.body, wish.file.path) {}

  void take(const RecordedMessage& message) override {
    placed_.clear();
    frames_.take(message, placed_);
    for (const PlacedFrame& one : placed_) {
      if (one.place) counted_.push_back(*one.place);
      unnumbered_ |= !one.place;
    }
  }

  Result<void> finish(HeardDevice& heard) override {
    frames_.report();
    append(heard.findings, frames_.findings);
    const BvhHierarchy hierarchy = KA_TRY(hierarchy_of(heard, wish_.file.path));
    heard.by_arrival = unnumbered_;
    if (unnumbered_) return {};
    const double rate = wish_.options.rate_hz;
    const double step = rate > 0.0 ? 1.0 / rate : hierarchy.frame_seconds;
    CountedClock clock = counted_clock(counted_, 1e9 * step, heard.utc_minus_host, wish_.file.path);
    append(heard.findings, clock.findings);
    heard.step_ns = clock.step_ns;
    heard.clock = std::move(clock.clock);
    return {};
  }

 private:
  DeviceWish wish_;
  NoitomFrames frames_;
  std::vector<PlacedFrame> placed_;
  std::vector<CountedFrame> counted_;
  bool unnumbered_ = false;
};

class NoitomRows final : public DeviceRows<ClipFrames> {
 public:
  NoitomRows(const DeviceWish& wish, std::shared_ptr<const HeardDevice> heard)
      : wish_(wish), heard_(std::move(heard)), frames_(wish.body, wish.file.path) {
    const auto hierarchy = hierarchy_of(*heard_, wish_.file.path);  // listening has read it before
    if (!hierarchy) return;
    const BvhOptions options = bvh_options(wish_.options);
    const std::string name = heard_->channel.stream + ".bvh";
    skeleton_ = skeleton_of(*hierarchy, options, name, findings);
    poser_.emplace(*hierarchy, options, name);
    append(findings, poser_->findings());
    append(findings, judge_size(*hierarchy, skeleton_, {}, options, name));
  }

  Result<void> take(const RecordedMessage& message, ClipFrames& out) override {
    placed_.clear();
    frames_.take(message, placed_);
    for (const PlacedFrame& one : placed_) {
      const auto stamp = stamp_at(one);
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
    if (unknown_ > 0) {
      findings.push_back({Severity::note,
                          Error{wish_.file.path, 0, "frames whose clock is known",
                                fmt::format("{} others", unknown_)},
                          "they were left out", ""});
    }
    return {};
  }

  const Skeleton* header() const override { return &skeleton_; }

 private:
  std::optional<Time> stamp_at(const PlacedFrame& one) const {
    if (heard_->by_arrival) {
      return Time{one.arrival.time_since_epoch() + heard_->utc_minus_host};
    }
    if (!one.place) return std::nullopt;
    return stamp_of(heard_->clock, one.place->life, counter_of(*one.place, heard_->step_ns),
                    one.arrival);
  }

  DeviceWish wish_;
  std::shared_ptr<const HeardDevice> heard_;
  NoitomFrames frames_;
  Skeleton skeleton_;
  std::optional<NoitomPoser> poser_;
  std::vector<PlacedFrame> placed_;
  std::optional<Error> misfit_;
  std::uint64_t posed_ = 0, misfits_ = 0, unknown_ = 0;
};

}  // namespace

DeviceProtocol noitom_protocol() { return device_protocol<NoitomListener, NoitomRows>("noitom"); }

}  // namespace kinalign
