// SPDX-License-Identifier: Apache-2.0
// Reads a BVH file in pieces: converts rows of channels to local positions and rotations.
#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/formats/bvh/rows.h"
#include "kinalign/motion/stamps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace kinalign {

namespace {

// The square root of 1/2. A rotation by -90 degrees about x converts z up to y up.
constexpr double half_root = 0.70710678118654752440;

/// Reads a BVH file. values_ parses the text, and poser_ makes poses from its frames. The skeleton
/// exists when the head is complete.
class BvhReader final : public ClipReader {
 public:
  BvhReader(const BvhOptions& options, const std::string& name)
      : options_(options),
        name_(name),
        values_(name, [this](const BvhHierarchy& h) { begin(h); }) {}
  BvhReader(const BvhReader&) = delete;  // a callback in values_ contains this address
  BvhReader& operator=(const BvhReader&) = delete;
  ~BvhReader() override = default;

  Result<void> feed(std::string_view piece, ClipFrames& out) override {
    KA_TRY(values_.feed(piece, findings));
    release(out);
    return {};
  }

  Result<void> finish(ClipFrames& out) override {
    KA_TRY(values_.finish(findings));
    release(out);
    // If the file has no frame, the rest pose is checked.
    if (!judged_) judge({});
    return {};
  }

  const Skeleton* header() const override { return values_.has_rows() ? &skeleton_ : nullptr; }

  // read_bvh() moves the hierarchy out of the reader.
  BvhHierarchy& hierarchy() { return values_.hierarchy(); }
  int decimals() const { return values_.decimals(); }
  /// From now on also appends all channel values to `values`, for read_bvh(), and counts their
  /// decimals.
  void keep_values(std::vector<double>& values) {
    kept_ = &values;
    values_.count_decimals = true;
  }

 private:
  /// values_ calls this when the head is complete, before the first row.
  void begin(const BvhHierarchy& hierarchy) {
    skeleton_ = skeleton_of(hierarchy, options_, name_, findings);
    poser_.emplace(hierarchy, options_);
  }

  /// Appends the poses of all complete frames to `out`.
  void release(ClipFrames& out) {
    if (!values_.has_rows()) return;
    // An incomplete frame stays in values_ until the rest of the frame arrives.
    const auto values = values_.frames();
    poser_->append(values, out);
    if (!judged_ && !values.empty()) judge(values);
    if (kept_ != nullptr) kept_->insert(kept_->end(), values.begin(), values.end());
    values_.drop_frames();
  }

  /// Checks size and up axis once, with the first rows.
  void judge(std::span<const double> rows) {
    append(findings, judge_size(values_.hierarchy(), skeleton_, rows, options_, name_));
    judged_ = true;
  }

  BvhOptions options_;
  std::string name_;
  BvhValues values_;
  bool judged_ = false;  // true when size and up axis have been checked
  Skeleton skeleton_;
  std::optional<BvhPoser> poser_;
  std::vector<double>* kept_ = nullptr;  // target of keep_values(); nullptr if there is none
};

}  // namespace

BvhOptions bvh_options(const StreamOptions& options) {
  BvhOptions out;
  if (options.metres_per_unit > 0.0) out.metres_per_unit = options.metres_per_unit;
  out.z_up = options.up == "z";
  // The first frame is later than the user's click, by the click's latency.
  out.start = utc_time(options.start_ns.value_or(0)) +
              Duration{std::llround(options.click_latency_ms * 1e6)};
  return out;
}

BvhPoser::BvhPoser(const BvhHierarchy& hierarchy, const BvhOptions& options)
    : row_size_(hierarchy.row_size()), options_(options), frame_ns_(hierarchy.frame_seconds * 1e9) {
  int column = 0;
  for (std::size_t j = 0; j < hierarchy.names.size(); ++j) {
    Joint joint;
    joint.offset = hierarchy.offsets[j] * options.metres_per_unit;
    joint.root = hierarchy.parents[j] < 0;
    std::array<int, 3> axes{-1, -1, -1};
    std::size_t rotations = 0;
    // Rotations apply in the order of the channels in the row.
    for (const Channel channel : hierarchy.channels[j]) {
      if (channel < 3) {
        joint.position[channel] = column;
      } else {
        axes[rotations] = channel - 3;
        joint.angle[rotations++] = column;
      }
      ++column;
    }
    // A missing rotation has angle zero, but EulerOrder needs three different axes.
    for (int axis = 0; axis < 3 && rotations < 3; ++axis) {  // axes without a channel come last
      if (std::find(axes.begin(), axes.end(), axis) == axes.end()) axes[rotations++] = axis;
    }
    joint.order = {axes[0], axes[1], axes[2]};
    joints_.push_back(joint);
  }
}

/// Writes one joint's positions in all frames. `positions` begins at the joint in the first frame.
void BvhPoser::place(const Joint& joint, std::span<const double> values,
                     std::span<double> positions) const {
  // Rows of the file have `row_size_` numbers, and frames of the output have `stride` numbers.
  const std::size_t stride = 3 * joints_.size(), frames = values.size() / row_size_;
  for (std::size_t k = 0; k < 3; ++k) {
    double* to = &positions[k];
    // A component without a channel is the component of OFFSET.
    if (joint.position[k] < 0) {
      const double offset = joint.offset[static_cast<int>(k)];
      for (std::size_t i = 0; i < frames; ++i) to[i * stride] = offset;
    } else {
      const double* from = &values[static_cast<std::size_t>(joint.position[k])];
      const double scale = options_.metres_per_unit;
      for (std::size_t i = 0; i < frames; ++i) to[i * stride] = from[i * row_size_] * scale;
    }
  }
  // Converts z up to y up: x = x, y = z, z = -y.
  if (!options_.z_up || !joint.root) return;
  for (std::size_t i = 0; i < frames; ++i) {
    double* p = &positions[i * stride];
    std::swap(p[1], p[2]);
    p[2] = -p[2];
  }
}

/// Writes one joint's rotations in all frames. `rotations` begins at the joint in the first frame.
void BvhPoser::turn(const Joint& joint, std::span<const double> values,
                    std::span<double> rotations) const {
  const std::size_t stride = 4 * joints_.size(), frames = values.size() / row_size_;
  EulerColumns columns;
  for (std::size_t k = 0; k < 3; ++k) {
    // If an axis has no channel, its pointer stays nullptr and its angle is zero.
    if (joint.angle[k] >= 0) columns.angles[k] = &values[static_cast<std::size_t>(joint.angle[k])];
  }
  columns.stride = row_size_;
  columns.rotations = rotations.data();
  columns.rotation_stride = stride;
  rotations_from_euler(joint.order, columns, frames);
  // A root's rotation is in the world, so the conversion from z up to y up is multiplied from the
  // left.
  if (!options_.z_up || !joint.root) return;
  for (std::size_t i = 0; i < frames; ++i) {
    const auto q = rotations.subspan(i * stride, 4);
    put_quat(q, 0, Quat(half_root, -half_root, 0.0, 0.0) * quat(q, 0));
  }
}

void BvhPoser::append(std::span<const double> values, ClipFrames& out) {
  const std::size_t joints = joints_.size(), frames = values.size() / row_size_;
  // `out` may contain frames of earlier blocks.
  const std::size_t before = out.size();
  out.local_positions.resize((before + frames) * joints * 3);
  out.local_rotations.resize((before + frames) * joints * 4);
  for (std::size_t i = 0; i < frames; ++i) {
    out.stamps.push_back(frame_stamp(options_.start, frame_ns_, frames_++));
  }
  // Converts all joints of a few frames, then the next few frames, so that the rows stay in the
  // first-level cache.
  for (std::size_t first = 0; first < frames; first += euler_frames) {
    const std::size_t some = std::min(euler_frames, frames - first);
    const auto rows = values.subspan(first * row_size_, some * row_size_);
    for (std::size_t j = 0; j < joints; ++j) {
      const std::size_t cell = (before + first) * joints + j;
      place(joints_[j], rows, std::span(out.local_positions).subspan(3 * cell));
      turn(joints_[j], rows, std::span(out.local_rotations).subspan(4 * cell));
    }
  }
}

std::unique_ptr<ClipReader> make_bvh_reader(const BvhOptions& options, const std::string& name) {
  return std::make_unique<BvhReader>(options, name);
}

Result<BvhFile> read_bvh(std::string_view text, std::string_view name, const BvhOptions& options) {
  BvhFile file;
  BvhReader reader(options, std::string(name));
  reader.keep_values(file.values);
  KA_TRY(reader.feed(text, file.clip.frames));
  KA_TRY(reader.finish(file.clip.frames));
  // finish() has succeeded, so the header exists.
  file.clip.skeleton = *reader.header();
  file.hierarchy = std::move(reader.hierarchy());
  file.decimals = reader.decimals();
  file.findings = std::move(reader.findings);
  return file;
}

}  // namespace kinalign
