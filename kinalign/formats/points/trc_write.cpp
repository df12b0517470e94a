// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/cells.h"
#include "kinalign/formats/points/trc.h"
#include "kinalign/formats/row_stamps.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

constexpr int decimals = 5;  // of millimetres: 0.005 um
constexpr double millimetres = 1000.0;

Failure refuse(std::string expected, std::string found) {
  return Failure(Error{"", 0, std::move(expected), std::move(found)});
}

}  // namespace

TrcWriter::TrcWriter(const TrcHead& head, TextOut& out)
    : out_(&out), markers_(head.names.size()), frames_(head.frames), zero_(head.zero) {}

Result<TrcWriter> TrcWriter::begin(const TrcHead& head, TextOut& out) {
  if (head.names.empty()) return refuse("one marker or more for a TRC", "none");
  for (const std::string& name : head.names) {
    if (!fits_a_cell(name)) return refuse("names of markers for a TRC without tabs", shown(name));
  }
  if (!(head.rate_hz > 0.0)) return refuse("a rate for a TRC", fmt::format("{}", head.rate_hz));
  out.text("PathFileType\t4\t(X/Y/Z)\t" +
           std::string(fits_a_cell(head.file) ? head.file : "points.trc"));
  KA_TRY(out.end_line());
  out.text(
      "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
      "OrigNumFrames");
  KA_TRY(out.end_line());
  const std::string rate = fmt::format("{}", head.rate_hz);
  out.text(fmt::format("{}\t{}\t{}\t{}\tmm\t{}\t1\t{}", rate, rate, head.frames, head.names.size(),
                       rate, head.frames));
  KA_TRY(out.end_line());
  out.text("Frame#\tTime");
  for (const std::string& name : head.names) out.text("\t" + name + "\t\t");
  KA_TRY(out.end_line());
  out.text("\t");
  for (std::size_t j = 1; j <= head.names.size(); ++j)
    out.text(fmt::format("\tX{0}\tY{0}\tZ{0}", j));
  KA_TRY(out.end_line());
  KA_TRY(out.end_line());
  return TrcWriter(head, out);
}

Result<void> TrcWriter::append(const PointFrames& frames) {
  for (std::size_t t = 0; t < frames.size(); ++t) {
    ++written_;
    out_->integer(static_cast<std::int64_t>(written_));
    out_->text("\t" + seconds_text((frames.stamps[t] - zero_).count()));
    for (std::size_t i = t * markers_; i < (t + 1) * markers_; ++i) {
      if (frames.state[i] == Tracking::missing) {
        out_->text("\t\t\t");
        continue;
      }
      for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
        out_->number('\t', frames.positions[k] * millimetres, decimals);
      }
    }
    KA_TRY(out_->end_line());
  }
  return {};
}

Result<void> TrcWriter::finish() const {
  if (written_ == frames_) return {};
  return refuse(fmt::format("{} frames for a TRC", frames_), std::to_string(written_));
}

}  // namespace kinalign
