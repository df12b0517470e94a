// SPDX-License-Identifier: Apache-2.0
// Reads the frames of a source that numbers its frames, for noitom_rows.cpp and xsens_rows.cpp.
// node_rows.cpp uses the same kind of clock for nodes without a counter.
#pragma once

#include "kinalign/protocols/protocols.h"
#include "kinalign/protocols/sequence_count.h"
#include "kinalign/recording/streams/counted_clock.h"
#include "kinalign/recording/streams/device_rows.h"
#include "kinalign/recording/streams/rows_in_order.h"
#include "kinalign/wire/little_endian_reader.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace kinalign {

/// A frame with its position in the count of its sender.
template <class Frame>
struct PlacedFrame {
  Frame frame;
  std::optional<CountedFrame> place;  // empty if the frame has no number
  HostTime arrival{};
};

/// The frames of one body, without duplicates. `Source` defines the types Decoder, Arrival and
/// Frame, and returns frame and body of an arrival. Each connection and each sender has its own
/// decoder, which counts the frames of each body.
template <class Source>
class NumberedFrames {
 public:
  using Placed = PlacedFrame<typename Source::Frame>;

  /// If no body is given, the body of the first frame is used.
  explicit NumberedFrames(std::optional<std::uint64_t> body) : body_(body) {}

  void take(const RecordedMessage& message, std::vector<Placed>& out) {
    Channel& from = channels_[message.channel_id];
    from.id = message.channel_id;
    from.lossless = !is_datagrams(message.channel->transport);
    arrivals_.clear();
    feed(from, message);
    place(from, message.arrival, out);
  }
  /// Call this after the last message. It passes on the frames that a decoder has delayed.
  void finish(std::vector<Placed>& out) {
    if constexpr (holds_back) {
      for (auto& [id, from] : channels_) {
        arrivals_.clear();
        from.decoder.finish(arrivals_);
        place(from, HostTime{}, out);  // each of these frames has its own arrival
      }
    }
  }

  /// The number of frames of other types or bodies than selected.
  std::uint64_t others() const { return others_; }
  /// Findings about the bytes, and about duplicates. If several connections have the same finding,
  /// it is returned once.
  Findings findings(const std::string& file) const {
    Findings all;
    for (const auto& [id, channel] : channels_) {
      for (Finding& one : channel.decoder.findings(file)) {
        const auto same = [&one](const Finding& f) { return f.what.found == one.what.found; };
        if (std::none_of(all.begin(), all.end(), same)) all.push_back(std::move(one));
      }
    }
    // A sender that restarts less than 1024 numbers back also repeats numbers (SequenceCount).
    if (duplicates_ > 0) {
      all.push_back({Severity::note,
                     Error{file, 0, "each frame number once",
                           std::to_string(duplicates_) + " frames that repeat an earlier number"},
                     "they were left out: the network duplicated them, or the sender restarted",
                     ""});
    }
    return all;
  }

 private:
  using Arrival = typename Source::Arrival;
  /// True if the decoder needs whole datagrams and may return a frame later than it arrived.
  static constexpr bool holds_back = requires(Arrival one) { one.arrival; };
  struct Channel {
    typename Source::Decoder decoder;
    std::int64_t counted = 0;
    std::uint16_t id = 0;
    bool lossless = false;
  };

  void feed(Channel& from, const RecordedMessage& message) {
    if constexpr (holds_back) {
      if (!from.lossless) {
        from.decoder.feed_datagram(octets(message.payload), message.arrival, arrivals_);
        return;
      }
    }
    from.decoder.feed(octets(message.payload), arrivals_);
  }
  /// Selects the body's frames and gives each frame its number. The channel is part of `life`, so
  /// that each connection has a separate count.
  void place(Channel& from, HostTime arrival, std::vector<Placed>& out) {
    for (Arrival& one : arrivals_) {
      auto* frame = Source::frame(one);
      if (frame != nullptr && !body_) body_ = Source::body(one);
      if (frame == nullptr || Source::body(one) != *body_) {
        ++others_;
        continue;
      }
      if (one.order == Order::duplicate) {
        ++duplicates_;
        continue;
      }
      // If the source sends no numbers, frames of a connection are counted instead, because a
      // connection loses no frames.
      std::optional<SequencePlace> place = one.place;
      if (!place && from.lossless) place = SequencePlace{0, from.counted++};
      Placed placed{std::move(*frame), {}, arrival};
      if constexpr (holds_back) placed.arrival = one.arrival.value_or(arrival);
      if (place) {
        // The upper 32 bits are the channel's id, and the lower 32 bits are the run of the sender.
        const BootKey life = (place->run + 1) | BootKey{from.id} << 32U;
        placed.place = CountedFrame{life, place->number, placed.arrival};
      }
      out.push_back(std::move(placed));
    }
  }

  std::optional<std::uint64_t> body_;
  std::uint64_t others_ = 0, duplicates_ = 0;
  std::map<std::uint16_t, Channel> channels_;
  std::vector<Arrival> arrivals_;
};

/// The stamp of a numbered frame; empty if its clock is not known.
inline std::optional<Time> stamp_of(const LearnedDevice& learned, const CountedFrame& frame) {
  return stamp_of(learned.clock, frame.life, counter_of(frame, learned.step_ns), frame.arrival);
}

// In all observed recordings, no frame arrived later than this many newer frames.
constexpr std::size_t most_reordered_frames = 16;

/// Stamps the frames of a message that contains no time. The stamp of the last frame is the arrival
/// of the message. The earlier frames are `step_ns` apart, or less if they would be earlier than
/// the previous message.
class ArrivalStamps {
 public:
  explicit ArrivalStamps(const LearnedDevice& learned)
      : step_(std::llround(learned.step_ns)), utc_minus_host_(learned.utc_minus_host) {}

  /// Calls `take` once for each of the message's `frames` frames.
  template <class Take>
  void add(HostTime arrived, std::size_t frames, const Take& take) {
    const Time arrival{arrived.time_since_epoch() + utc_minus_host_};
    // The number of time steps from a frame to the last frame of the message.
    auto behind = static_cast<Duration::rep>(frames);
    Duration step = step_;
    // Frames must not be earlier than the previous message, because stamps must rise.
    if (any_before_) step = std::clamp((arrival - before_) / behind, Duration{0}, step);
    for (std::size_t k = 0; k < frames; ++k) take(k, arrival - --behind * step);
    any_before_ = true;
    before_ = arrival;
  }

 private:
  Duration step_, utc_minus_host_;
  bool any_before_ = false;
  Time before_{};
};

/// The data that are kept of each frame, so that its row can be stamped when the clock is known.
class FrameKeys {
 public:
  /// Adds the frames of a message. `shape` returns a number that later decides whether the frame
  /// gives a row.
  template <class Frame, class Shape>
  void add(const std::vector<PlacedFrame<Frame>>& placed, const Shape& shape) {
    for (const auto& one : placed) {
      Key key{{}, one.place.has_value(), &one == &placed.back(), shape(one.frame)};
      key.frame = one.place.value_or(CountedFrame{0, 0, one.arrival});
      key.frame.arrival = one.arrival;
      keys_.push_back(key);
    }
  }
  bool empty() const { return keys_.empty(); }
  bool any_unnumbered() const {
    return std::any_of(keys_.begin(), keys_.end(), [](const Key& k) { return !k.is_numbered; });
  }
  std::vector<CountedFrame> counted() const {
    std::vector<CountedFrame> frames;
    for (const Key& key : keys_) {
      if (key.is_numbered) frames.push_back(key.frame);
    }
    return frames;
  }
  /// Passes on the stamp of each row. `fits` decides by a frame's shape whether it gives a row; it
  /// is called in the order of the rows. Frames are sorted by the same queue as in NumberedRows, so
  /// the order is the same.
  template <class Fits>
  void stamp_rows(const LearnedDevice& learned, Fits fits,
                  const DeviceListener::TakeStamp& take) const {
    const auto put = [&](Time stamp, std::uint32_t shape) {
      if (fits(shape)) take(stamp);
    };
    if (learned.by_arrival) return stamp_by_arrivals(learned, put);
    RowsInOrder<std::uint32_t> stamps(most_reordered_frames);
    for (const Key& key : keys_) {
      const auto stamp = key.is_numbered ? stamp_of(learned, key.frame) : std::nullopt;
      stamps.add(stamp, key.shape, put);
    }
    stamps.finish(put);
  }

 private:
  struct Key {
    CountedFrame frame;
    bool is_numbered = false, ends_message = false;
    std::uint32_t shape = 0;
  };
  /// Stamps the frames of each message by the message's arrival.
  template <class Put>
  void stamp_by_arrivals(const LearnedDevice& learned, const Put& put) const {
    ArrivalStamps stamps(learned);
    for (auto first = keys_.begin(); first != keys_.end();) {
      const auto last =
          std::find_if(first, keys_.end(), [](const Key& key) { return key.ends_message; });
      stamps.add(last->frame.arrival, static_cast<std::size_t>(last - first) + 1,
                 [&](std::size_t k, Time stamp) {
                   put(stamp, (first + static_cast<std::ptrdiff_t>(k))->shape);
                 });
      first = last + 1;
    }
  }

  std::deque<Key> keys_;  // a growing vector may occupy twice the needed memory
};

/// Makes rows of numbered frames, in the order of their numbers. Frames that the network reordered
/// are sorted. `Source::frames` is a word for frames. `Source::what` is the text for an error if
/// there are none.
template <class Source, class Frames>
class NumberedRows : public DeviceRows<Frames> {
 public:
  NumberedRows(const DeviceRequest& request, std::shared_ptr<const LearnedDevice> learned)
      : DeviceRows<Frames>(request.file.path),
        learned_(std::move(learned)),
        frames_(request.body) {}

  Result<void> take(const RecordedMessage& message, Frames& out) final {
    placed_.clear();
    frames_.take(message, placed_);
    put_placed(out);
    return {};
  }

  /// Makes the remaining rows and adds findings about frames that were left out. Fails if there is
  /// no row, unless the header is known and every frame fitted.
  Result<void> finish(Frames& out) final {
    placed_.clear();
    frames_.finish(placed_);
    put_placed(out);
    waiting_.finish(putting(out));
    if (appended_ == 0 && (misfit_ || this->header() == nullptr)) {
      return Failure(misfit_.value_or(Error{this->file(), 0, std::string(Source::what), "none"}));
    }
    kinalign::append(this->findings, further_findings());
    const std::string frames(Source::frames);
    if (misfit_) {
      this->findings.push_back(
          {Severity::warning, *misfit_,
           std::to_string(misfits_) + " " + frames + " of that kind were left out", ""});
    }
    this->warn_too_late(waiting_, frames);
    this->note(waiting_.unstamped(), frames + " whose clock is known",
               frames + " without a known clock", "they were left out");
    return {};
  }

 private:
  /// Appends a row. Fails and appends nothing if the frame does not fit.
  virtual Result<void> append(const typename Source::Frame& frame, Time stamp, Frames& out) = 0;
  virtual Findings further_findings() const { return {}; }

  // The error of the first frame that does not fit is kept as an example for the finding.
  void put(const typename Source::Frame& frame, Time stamp, Frames& out) {
    auto appended = append(frame, stamp, out);
    if (appended) {
      ++appended_;
      return;
    }
    if (!misfit_) misfit_ = std::move(appended).error();
    ++misfits_;
  }
  /// Makes rows of the frames in placed_, stamped by arrival or by clock.
  void put_placed(Frames& out) {
    if (placed_.empty()) return;
    // Arrivals rise already, so rows that are stamped by arrival need no sorting.
    if (learned_->by_arrival) {
      arrivals_.add(placed_.back().arrival, placed_.size(),
                    [&](std::size_t k, Time stamp) { put(placed_[k].frame, stamp, out); });
      return;
    }
    for (auto& one : placed_) {
      const auto stamp = one.place ? stamp_of(*learned_, *one.place) : std::nullopt;
      waiting_.add(stamp, std::move(one.frame), putting(out));
    }
  }
  auto putting(Frames& out) {
    return [&](Time stamp, const typename Source::Frame& frame) { put(frame, stamp, out); };
  }

  std::shared_ptr<const LearnedDevice> learned_;
  NumberedFrames<Source> frames_;
  std::vector<PlacedFrame<typename Source::Frame>> placed_;
  RowsInOrder<typename Source::Frame> waiting_{most_reordered_frames};
  ArrivalStamps arrivals_{*learned_};  // for frames without a clock
  std::optional<Error> misfit_;
  std::uint64_t appended_ = 0, misfits_ = 0;
};

}  // namespace kinalign
