// SPDX-License-Identifier: Apache-2.0
// Reads the segments of an MVNX file as a skeleton and its motion.
#include "kinalign/formats/axes.h"
#include "kinalign/formats/mvnx/document.h"
#include "kinalign/formats/mvnx/frame_stamps.h"
#include "kinalign/formats/mvnx/mvnx.h"
#include "kinalign/formats/point_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace kinalign {

namespace {

/// Positions (m) and rotations of all segments in the world, in kinalign's axes. The axes of the
/// segments are converted like those of the world, so a segment at rest has no rotation.
struct GlobalPose {
  std::vector<Vec3> places;
  std::vector<Quat> turns;
};

/// The conversion from the file's axes and unit to kinalign's.
struct MvnxUnits {
  PointUnits units;
  Quat turn;

  /// Lengths are in metres, unless the user gave another unit.
  explicit MvnxUnits(const StreamOptions& options)
      : units(point_units({z_up, 1.0}, options)), turn(rotation_of(units.axes)) {}

  Vec3 ours(const Vec3& file) const { return turned(units.axes, file.data()) * units.metres; }
};

/// The pose of a frame. The result is empty if the frame lacks a segment, or if the length of a
/// quaternion is not within 0.99 to 1.01.
std::optional<GlobalPose> pose_of(const MvnxFrame& frame, std::size_t segments,
                                  const MvnxUnits& units) {
  // If the frame has fewer numbers, a segment is missing.
  if (frame.orientation.size() != 4 * segments || frame.position.size() != 3 * segments) return {};
  GlobalPose out;
  for (std::size_t k = 0; k < segments; ++k) {
    const Quat q = quat(frame.orientation, k);
    // Rounding in the text changes the length by less than 1 %. Any other length is not a rotation.
    if (!(std::abs(q.norm() - 1.0) <= 0.01)) return std::nullopt;
    // T q T^-1, where T converts the axes, is the same rotation in kinalign's axes.
    out.turns.push_back((units.turn * q * units.turn.conjugate()).normalized());
    out.places.push_back(units.ours(vec3(frame.position, k)));
  }
  return out;
}

/// The parent of each segment; -1: a root. A segment is a root if it is the child of no joint.
std::vector<int> parents_of(const MvnxHead& head) {
  const auto index = [&](const std::string& label) {
    const auto found = std::find_if(head.segments.begin(), head.segments.end(),
                                    [&](const MvnxSegment& s) { return s.label == label; });
    return found == head.segments.end() ? -1 : static_cast<int>(found - head.segments.begin());
  };
  std::vector<int> out(head.segments.size(), -1);
  for (const MvnxJoint& joint : head.joints) {
    const int child = index(joint.child);
    if (child >= 0) out[static_cast<std::size_t>(child)] = index(joint.parent);
  }
  return out;
}

const MvnxPoint* point_named(const MvnxSegment& segment, const std::string& label) {
  const auto found = std::find_if(segment.points.begin(), segment.points.end(),
                                  [&](const MvnxPoint& p) { return p.label == label; });
  return found == segment.points.end() ? nullptr : &*found;
}

/// The offset from the parent's origin to the child's origin, in the file's axes. It is the
/// difference of the two points that their joint connects, which are the same place in the world.
/// The result is empty if the file lacks the joint or one of the points.
std::optional<Vec3> offset_by_points(const MvnxHead& head, std::size_t child, std::size_t parent) {
  for (const MvnxJoint& joint : head.joints) {
    if (joint.child != head.segments[child].label || joint.parent != head.segments[parent].label) {
      continue;
    }
    const MvnxPoint* from = point_named(head.segments[parent], joint.parent_point);
    const MvnxPoint* to = point_named(head.segments[child], joint.child_point);
    if (from != nullptr && to != nullptr) return from->place - to->place;
  }
  return std::nullopt;
}

/// Converts global poses to local poses. The skeleton is made at the first normal frame, when the
/// calibration poses are known.
class MvnxReader final : public ClipReader {
 public:
  MvnxReader(const StreamOptions& options, std::string_view file)
      : units_(options),
        stamps_(options),
        document_(file, [this](const MvnxHead& head, const MvnxFrame& frame) {
          return use(head, frame);
        }) {}
  // A callback in document_ contains the address of this object.
  MvnxReader(const MvnxReader&) = delete;
  MvnxReader& operator=(const MvnxReader&) = delete;
  ~MvnxReader() override = default;

  Result<void> feed(std::string_view piece, ClipFrames& out) override {
    // During feed(), document_ calls use(), which appends to out_.
    out_ = &out;
    return document_.feed(piece);
  }

  Result<void> finish(ClipFrames& out) override {
    out_ = &out;
    KA_TRY(document_.finish(findings));
    const std::string& file = document_.file();
    if (!header_) {
      return refuse(file, "a frame of type normal with all segments",
                    fmt::format("the end of the file after {} incomplete frames", incomplete_));
    }
    if (incomplete_ > 0) {
      add_warning(findings,
                  {file, 0, "orientation and position of all segments in each frame",
                   fmt::format("{} frames without them", incomplete_)},
                  "these frames were left out");
    }
    stamps_.report(file, findings);
    return {};
  }

  const Skeleton* header() const override { return header_ ? &*header_ : nullptr; }

 private:
  /// Called for each frame. Keeps calibration poses, and appends normal frames.
  Result<void> use(const MvnxHead& head, const MvnxFrame& frame) {
    const auto pose = pose_of(frame, head.segments.size(), units_);
    // A calibration pose is kept but not appended.
    if (frame.type != "normal") {
      keep_rest(frame.type, pose);
      return {};
    }
    if (!pose) {
      ++incomplete_;
      return {};
    }
    // A frame whose index does not rise is left out.
    const auto stamp = KA_TRY(stamps_.next(head, frame));
    if (!stamp) return {};
    if (!header_) KA_TRY(begin(head, *pose));
    append(*pose, *stamp);
    return {};
  }

  /// Keeps a calibration pose as rest pose. The identity pose is preferred to a T-pose.
  void keep_rest(const std::string& type, const std::optional<GlobalPose>& pose) {
    // A T-pose is kept only if no other pose is known.
    if (!pose || (rest_ && type != "identity")) return;
    rest_ = pose;
  }

  /// Makes the skeleton at the first normal frame.
  Result<void> begin(const MvnxHead& head, const GlobalPose& first) {
    if (head.segments.empty()) return refuse("segments before the frames", "none");
    Skeleton skeleton;
    skeleton.parents = parents_of(head);
    // Without a calibration pose, the first frame serves as rest pose.
    const GlobalPose& rest = rest_ ? *rest_ : first;
    for (std::size_t k = 0; k < head.segments.size(); ++k) {
      skeleton.joint_names.push_back(head.segments[k].label);
      skeleton.rest_offsets.push_back(rest_offset(head, skeleton.parents[k], k, rest));
    }
    add_end_sites(head, skeleton);
    // validate() refuses a skeleton in which a parent comes after its child.
    KA_TRY(validate(skeleton));
    header_ = std::move(skeleton);
    return {};
  }

  Vec3 rest_offset(const MvnxHead& head, int parent, std::size_t k, const GlobalPose& rest) const {
    // A root's offset is its position in the rest pose.
    if (parent < 0) return rest.places[k];
    const auto p = static_cast<std::size_t>(parent);
    // The offset between points is exact. A pose only gives an estimate.
    if (const auto offset = offset_by_points(head, k, p)) return units_.ours(*offset);
    return rest.turns[p].conjugate() * (rest.places[k] - rest.places[p]);
  }

  /// Adds an end site to each segment without children: the segment's first point whose label
  /// begins with p. Such a label means that the point is not a joint. MVN lists the tips first.
  void add_end_sites(const MvnxHead& head, Skeleton& skeleton) const {
    for (std::size_t k = 0; k < head.segments.size(); ++k) {
      const auto& parents = skeleton.parents;
      // A segment with children needs no end site.
      if (std::find(parents.begin(), parents.end(), static_cast<int>(k)) != parents.end()) continue;
      for (const MvnxPoint& point : head.segments[k].points) {
        if (!point.label.starts_with('p')) continue;
        skeleton.end_sites.push_back({static_cast<int>(k), units_.ours(point.place)});
        break;
      }
    }
  }

  /// Appends a global pose as local positions and rotations.
  void append(const GlobalPose& pose, Time stamp) {
    const std::size_t segments = pose.places.size();
    const std::size_t first = out_->size() * segments;
    out_->stamps.push_back(stamp);
    out_->local_positions.resize(3 * (first + segments));
    out_->local_rotations.resize(4 * (first + segments));
    // parent^-1 * child is the position and rotation in the parent's space.
    for (std::size_t k = 0; k < segments; ++k) {
      Vec3 place = pose.places[k];
      Quat turn = pose.turns[k];
      if (header_->parents[k] >= 0) {
        const auto p = static_cast<std::size_t>(header_->parents[k]);
        const Quat parent = pose.turns[p].conjugate();
        place = parent * (place - pose.places[p]);
        turn = (parent * turn).normalized();
      }
      vec3(out_->local_positions, first + k) = place;
      put_quat(out_->local_rotations, first + k, turn);
    }
  }

  MvnxUnits units_;
  MvnxStamps stamps_;
  MvnxDocument document_;
  ClipFrames* out_ = nullptr;  // the output during a call
  std::optional<GlobalPose> rest_;
  std::uint64_t incomplete_ = 0;
  std::optional<Skeleton> header_;
};

}  // namespace

std::unique_ptr<ClipReader> make_mvnx_reader(const StreamOptions& options, std::string_view file) {
  return std::make_unique<MvnxReader>(options, file);
}

bool looks_like_mvnx(std::string_view head) {
  // The root element is within the first kilobytes.
  constexpr std::size_t searched = 4096;
  constexpr std::string_view element = "<mvnx";
  if (!looks_like_gzip(head)) {
    return head.starts_with('<') || head.starts_with("\xef\xbb\xbf<")
               ? head.substr(0, searched).find(element) != std::string_view::npos
               : false;
  }
  std::string text;
  // gunzip may fail early. The text before the failure is enough.
  Gunzip gunzip;
  // The callback stops the decompression when the text is long enough.
  const auto unpacked =
      gunzip.feed(head.substr(0, searched), [&](std::string_view more) -> Result<void> {
        text += more.substr(0, searched);
        if (text.size() < searched) return {};
        return Failure(Error{});
      });
  (void)unpacked;
  return text.find(element) != std::string::npos;
}

}  // namespace kinalign
