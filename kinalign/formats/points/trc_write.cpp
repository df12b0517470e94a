// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/cells.h"
#include "kinalign/formats/points/trc.h"
#include "kinalign/formats/row_stamps.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

constexpr int decimals = 5;  // of a millimetre, so the largest rounding error is 0.005 um
constexpr double millimetres = 1000.0;

/// Writes the six lines above the rows: three lines of keys and values, the names, the labels, and
/// an empty line.
Result<void> put_head(const TrcHead& head, TextOut& out) {
  // A tab in a name would shift the cells of its line.
  const std::string file = fits_a_cell(head.file) ? head.file : "points.trc";
  const std::string rate = fmt::format("{}", head.rate_hz);
  const std::size_t markers = head.names.size();
  out.text(
      "PathFileType\t4\t(X/Y/Z)\t" + file +
      "\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
      "OrigNumFrames\n");
  out.text(
      fmt::format("{0}\t{0}\t{1}\t{2}\tmm\t{0}\t1\t{1}\nFrame#\tTime", rate, head.frames, markers));
  // Each name stands above three columns.
  for (const std::string& name : head.names) out.text("\t" + name + "\t\t");
  out.text("\n\t");
  for (std::size_t j = 1; j <= markers; ++j) out.text(fmt::format("\tX{0}\tY{0}\tZ{0}", j));
  // OpenSim's files have this empty line.
  out.text("\n");
  return out.end_line();
}

}  // namespace

TrcWriter::TrcWriter(const TrcHead& head, TextOut& out)
    : out_(&out), markers_(head.names.size()), frames_(head.frames), zero_(head.zero) {}

Result<TrcWriter> TrcWriter::begin(const TrcHead& head, TextOut& out) {
  if (head.names.empty()) return refuse("at least one marker for a TRC", "none");
  for (const std::string& name : head.names) {
    if (!fits_a_cell(name)) return refuse("names of markers for a TRC without tabs", shown(name));
  }
  // The head contains the rate, so the rate must be known.
  if (!(head.rate_hz > 0.0)) return refuse("a rate for a TRC", fmt::format("{}", head.rate_hz));
  KA_TRY(put_head(head, out));
  return TrcWriter(head, out);
}

Result<void> TrcWriter::append(const PointFrames& frames) {
  for (std::size_t t = 0; t < frames.size(); ++t) {
    ++written_;
    out_->integer(static_cast<std::int64_t>(written_));
    // Times count from `zero`, because TRC files contain no date.
    out_->text("\t" + seconds_text((frames.stamps[t] - zero_).count()));
    for (std::size_t i = t * markers_; i < (t + 1) * markers_; ++i) {
      // Three empty cells keep the other markers in their columns.
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
  // The head already contains NumFrames.
  if (written_ == frames_) return {};
  return refuse(fmt::format("{} frames for a TRC", frames_), std::to_string(written_));
}

}  // namespace kinalign
