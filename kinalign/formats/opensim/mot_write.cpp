// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/opensim/mot_write.h"

#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/formats/cells.h"
#include "kinalign/formats/row_stamps.h"
#include "kinalign/motion/kinematics.h"

#include <fmt/format.h>

#include <array>
#include <span>
#include <utility>

namespace kinalign {

namespace {

constexpr int decimals = 6;

}  // namespace

/// The columns of the file: their names, and their values in each frame.
/// Angles and positions of roots come from BvhChannels, global positions from forward kinematics.
class MotWriter::Columns {
 public:
  /// Fixed at the start: later frames can't add columns, because the head is written already.
  explicit Columns(const MotHead& head)
      : skeleton_(head.skeleton),
        angles_(head.columns == MotColumns::joint_angles),
        channels_(head.skeleton) {
    // BvhChannels knows order and names of the channels.
    if (angles_) {
      name_channels();
    } else {
      for (const std::string& joint : skeleton_.joint_names) {
        for (const char* axis : {"_X", "_Y", "_Z"}) names_.push_back(joint + axis);
      }
      scales_.assign(names_.size(), 1.0);
    }
  }

  const std::vector<std::string>& names() const { return names_; }

  /// The values of the frames, [T, names], to be multiplied by scale().
  /// The result is valid until the next call: the array is reused for each block.
  const std::vector<double>& values(const ClipFrames& frames) {
    values_.clear();
    // Channels are in centimetres and degrees; scale() turns them into metres and degrees.
    if (angles_) {
      channels_.append(frames.local_positions, frames.local_rotations, values_);
    } else {
      values_.resize(frames.local_positions.size());
      forward_kinematics(skeleton_, frames, values_);
    }
    return values_;
  }
  double scale(std::size_t column) const { return scales_[column]; }

 private:
  /// Names the columns by the channels that a BVH of the skeleton would have.
  void name_channels() {
    constexpr std::array<const char*, 6> ends{"_tx", "_ty", "_tz", "_rx", "_ry", "_rz"};
    constexpr double metres = 0.01;  // the channels are in centimetres and degrees
    // Frames and step do not matter here, only the channels.
    const BvhHierarchy hierarchy = channels_.hierarchy(0, 1.0);
    for (std::size_t j = 0; j < hierarchy.names.size(); ++j) {
      for (const Channel channel : hierarchy.channels[j]) {
        names_.push_back(hierarchy.names[j] + ends[channel]);
        scales_.push_back(channel < 3 ? metres : 1.0);
      }
    }
  }

  Skeleton skeleton_;
  bool angles_;
  BvhChannels channels_;
  std::vector<std::string> names_;
  std::vector<double> scales_;  // [names]
  std::vector<double> values_;
};

MotWriter::MotWriter(const MotHead& head, TextOut& out, std::unique_ptr<Columns> columns)
    : out_(&out), columns_(std::move(columns)), frames_(head.frames), zero_(head.zero) {}
MotWriter::~MotWriter() = default;
MotWriter::MotWriter(MotWriter&&) noexcept = default;
MotWriter& MotWriter::operator=(MotWriter&&) noexcept = default;

Result<MotWriter> MotWriter::begin(const MotHead& head, TextOut& out) {
  if (head.skeleton.joints() == 0) return refuse("at least one joint for a .mot", "none");
  for (const std::string& name : head.skeleton.joint_names) {
    // OpenSim splits its columns at blanks, too.
    if (!fits_a_cell(name) || name.find(' ') != std::string::npos) {
      return refuse("names of joints for a .mot without tabs and blanks", "'" + shown(name) + "'");
    }
  }
  auto columns = std::make_unique<Columns>(head);
  const bool angles = head.columns == MotColumns::joint_angles;
  // nColumns counts the time, too.
  out.text(fmt::format("{}\nversion=1\nnRows={}\nnColumns={}\ninDegrees={}\nendheader\ntime",
                       angles ? "Coordinates" : "Positions", head.frames,
                       columns->names().size() + 1, angles ? "yes" : "no"));
  for (const std::string& name : columns->names()) out.text("\t" + name);
  KA_TRY(out.end_line());
  return MotWriter(head, out, std::move(columns));
}

Result<void> MotWriter::append(const ClipFrames& frames) {
  const std::vector<double>& values = columns_->values(frames);
  const std::size_t row = columns_->names().size();
  for (std::size_t t = 0; t < frames.size(); ++t) {
    ++written_;
    // Times count from `zero`, since OpenSim's numbers have no date.
    out_->text(seconds_text((frames.stamps[t] - zero_).count()));
    for (std::size_t c = 0; c < row; ++c) {
      // The joints are in the order of names(), which may differ from that of the skeleton.
      out_->number('\t', columns_->scale(c) * values[t * row + c], decimals);
    }
    KA_TRY(out_->end_line());
  }
  return {};
}

Result<void> MotWriter::finish() const {
  // nRows stands in the head, so another number of rows would make the file wrong.
  if (written_ == frames_) return {};
  return refuse(fmt::format("{} frames for a .mot", frames_), std::to_string(written_));
}

}  // namespace kinalign
