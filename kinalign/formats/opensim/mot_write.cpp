// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/opensim/mot_write.h"

#include "kinalign/formats/cells.h"
#include "kinalign/formats/row_stamps.h"

#include <fmt/format.h>

#include <array>

namespace kinalign {

namespace {

constexpr int decimals = 6;

}  // namespace

MotWriter::MotWriter(const MotHead& head, TextOut& out)
    : out_(&out), channels_(head.skeleton), frames_(head.frames), zero_(head.zero) {
  constexpr std::array<const char*, 6> ends{"_tx", "_ty", "_tz", "_rx", "_ry", "_rz"};
  constexpr double metres = 0.01;  // the channels are in centimetres and degrees
  // Only the channels matter here; the number of frames and the frame time do not.
  const BvhHierarchy hierarchy = channels_.hierarchy(0, 1.0);
  for (std::size_t j = 0; j < hierarchy.names.size(); ++j) {
    for (const Channel channel : hierarchy.channels[j]) {
      names_.push_back(hierarchy.names[j] + ends[channel]);
      scales_.push_back(channel < 3 ? metres : 1.0);
    }
  }
}

Result<MotWriter> MotWriter::begin(const MotHead& head, TextOut& out) {
  if (head.skeleton.joints() == 0) return refuse("at least one joint for a .mot", "none");
  for (const std::string& name : head.skeleton.joint_names) {
    // OpenSim also splits columns at blanks.
    if (!fits_a_cell(name) || name.find(' ') != std::string::npos) {
      return refuse("names of joints for a .mot without tabs and blanks", "'" + shown(name) + "'");
    }
  }
  MotWriter writer(head, out);
  // nColumns includes the time.
  out.text(
      fmt::format("Coordinates\nversion=1\nnRows={}\nnColumns={}\ninDegrees=yes\nendheader\ntime",
                  head.frames, writer.names_.size() + 1));
  for (const std::string& name : writer.names_) out.text("\t" + name);
  KA_TRY(out.end_line());
  return writer;
}

Result<void> MotWriter::append(const ClipFrames& frames) {
  values_.clear();
  channels_.append(frames.local_positions, frames.local_rotations, values_);
  const std::size_t row = names_.size();
  for (std::size_t t = 0; t < frames.size(); ++t) {
    ++written_;
    // Times count from `zero`, because times in OpenSim have no date.
    out_->text(seconds_text((frames.stamps[t] - zero_).count()));
    for (std::size_t c = 0; c < row; ++c) {
      // The channels are in the order of names_, which may differ from the order of the skeleton.
      out_->number('\t', scales_[c] * values_[t * row + c], decimals);
    }
    KA_TRY(out_->end_line());
  }
  return {};
}

Result<void> MotWriter::finish() const {
  // The head contains nRows, so another number of rows would make the file wrong.
  if (written_ == frames_) return {};
  return refuse(fmt::format("{} frames for a .mot", frames_), std::to_string(written_));
}

}  // namespace kinalign
