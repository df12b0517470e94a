// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/mvnx/frame_stamps.h"

#include <fmt/format.h>

#include <algorithm>

namespace kinalign {

namespace {

// A larger number is not an index. A double represents all whole numbers up to this limit exactly.
constexpr double largest_index = 1e12;

bool is_index(double x) { return x >= 0.0 && x < largest_index && x == std::floor(x); }

}  // namespace

Result<void> MvnxStamps::begin(const MvnxHead& head, const MvnxFrame& frame) {
  // The user's rate has priority over the rate in the file.
  rate_hz_ = options_.rate_hz > 0.0 ? options_.rate_hz : head.rate_hz;
  if (!(rate_hz_ >= 1e-3) || !(rate_hz_ <= 1e6)) {
    return refuse("a frameRate of 0.001 to 1,000,000 Hz, or rate_hz",
                  head.rate_hz == 0.0 ? "none" : fmt::format("{}", head.rate_hz));
  }
  // The indices of a file may begin with any number.
  first_index_ = frame.index.value_or(0.0);
  first_ms_ = frame.ms.value_or(0.0);
  constexpr double largest_ms = 1e-6 * static_cast<double>(largest_stamp_ns);
  const double unix_ms = frame.unix_ms.value_or(0.0);
  // A time of day out of range is ignored.
  const double start_ms = std::abs(unix_ms) < largest_ms ? unix_ms : 0.0;
  start_ns_ = options_.start_ns.value_or(std::llround(start_ms) * 1'000'000);
  return {};
}

Result<std::optional<Time>> MvnxStamps::next(const MvnxHead& head, const MvnxFrame& frame) {
  // Frames without an index are counted.
  const double index = frame.index.value_or(last_index_ + 1.0);
  if (!is_index(index)) {
    return refuse("a frame's index", fmt::format("{}", index));
  }
  // The first frame determines rate, index and start.
  if (!first_index_) KA_TRY(begin(head, frame));
  if (index <= last_index_) {
    ++not_rising_;
    return std::optional<Time>();
  }
  // If the index jumps ahead, the file lacks the frames in between.
  if (last_index_ >= 0.0) missing_ += static_cast<std::uint64_t>(index - last_index_ - 1.0);
  last_index_ = index;
  const double since = index - *first_index_;
  // The file's times are only compared, because the stamps come from the index.
  if (frame.ms) {
    const double off = 1e-3 * (*frame.ms - first_ms_) - since / rate_hz_;
    largest_off_s_ = std::max(largest_off_s_, std::abs(off));
  }
  std::int64_t ns = 0;
  // The sum may overflow although both terms are in range.
  const bool overflow = __builtin_add_overflow(
      start_ns_, stamp_at_rate(static_cast<std::uint64_t>(since), rate_hz_), &ns);
  if (overflow || ns > largest_stamp_ns || ns < -largest_stamp_ns) {
    return refuse("a stamp inside +-4e18 ns", fmt::format("frame {}", index));
  }
  return std::optional(utc_time(ns));
}

void MvnxStamps::report(const std::string& file, Findings& findings) const {
  if (not_rising_ > 0) {
    add_warning(
        findings,
        {file, 0, "frames with a rising index", fmt::format("{} other frames", not_rising_)},
        "these frames were left out");
  }
  if (missing_ > 0) {
    add_note(findings, {file, 0, "every frame index", fmt::format("{} missing indices", missing_)},
             "the missing frames are a gap");
  }
  // The file's milliseconds are rounded by up to half a millisecond. The tolerance is one
  // millisecond for the rounding of two times, and one and a half frames.
  if (largest_off_s_ > 0.001 + 1.5 / std::max(rate_hz_, 1e-3)) {
    add_warning(findings,
                {file, 0, fmt::format("times of frameRate {:g}", rate_hz_),
                 fmt::format("times that differ by up to {:.3g} s", largest_off_s_)},
                "the stamps are computed from index and rate",
                "find out which is correct: gaps and splines depend on it");
  }
}

}  // namespace kinalign
