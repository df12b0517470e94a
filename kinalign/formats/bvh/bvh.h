// SPDX-License-Identifier: Apache-2.0
// Reads and writes Biovision BVH. Layout: docs/formats/bvh.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/formats/clip_survey.h"
#include "kinalign/formats/file_sink.h"
#include "kinalign/formats/reader.h"
#include "kinalign/motion/kinematics.h"
#include "kinalign/take/manifest.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Facts that a BVH file does not state. They come from the manifest or have defaults.
struct BvhOptions {
  double metres_per_unit = 0.01;  // most writers, for example Axis Neuron, use centimetres
  bool z_up = false;              // the file's up axis is z; false: y
  Time start{};                   // stamp of frame 0
};

/// The options for the BVH file of a stream. click_latency_ms is added to the start stamp.
BvhOptions bvh_options(const StreamOptions& options);

/// One channel of a joint. 0 to 2: position x, y, z. 3 to 5: rotation about x, y, z.
using Channel = std::uint8_t;

/// The hierarchy above the rows, in the file's own units and names. Values are kept as in the file,
/// so that writing gives the same text again.
struct BvhHierarchy {
  std::vector<std::string> names;              // [J] as in the file; names may repeat
  std::vector<int> parents;                    // [J] index of each joint's parent; -1: a root
  std::vector<Vec3> offsets;                   // [J] in the file's unit
  std::vector<std::vector<Channel>> channels;  // [J] in the order of the values in a row
  std::vector<EndSite> end_sites;
  int offset_decimals = 6;       // decimals of the numbers after OFFSET
  std::uint64_t frames = 0;      // number stated in the file; the number of rows may differ
  std::int64_t frames_line = 0;  // line of "Frames:", counted from 1
  double frame_seconds = 0.0;
  std::string frame_time;  // the number after "Frame Time:" as text

  std::size_t row_size() const;  // number of values in a row (C)
};

/// A whole BVH file in memory. The clip and the values contain the same motion. The clip is for
/// computing, and the values are for writing.
struct BvhFile {
  BvhHierarchy hierarchy;
  Clip clip;                   // T frames, J joints; a repeated name gets #2, #3, ...
  std::vector<double> values;  // [T,C] as in the file: its units, degrees, also beyond +-180
  int decimals = 6;            // decimals of the values when they are written
  Findings findings;           // faults that did not stop the reading, such as a missing row
};

/// Parses everything above the rows. `text` must extend to the end of the number after "Frame
/// Time:". `rows` becomes the position of the first row. Fails if the hierarchy can't be
/// understood. Survey, reader and copy share this parser, so they agree on every file.
Result<BvhHierarchy> parse_bvh_hierarchy(std::string_view text, std::string_view name,
                                         std::size_t& rows, Findings& findings);

/// True if the first word is "HIERARCHY".
bool looks_like_bvh(std::string_view head);

/// The skeleton in metres. Repeated names become name#2, name#3 and so on, with a finding.
Skeleton skeleton_of(const BvhHierarchy& hierarchy, const BvhOptions& options,
                     std::string_view name, Findings& findings);

/// Checks whether a person's skeleton has a plausible size and stands upright. Otherwise a finding
/// suggests another metres_per_unit or another up axis. If the first row of `rows` [n,C] clearly
/// shows which axis is up, it decides; otherwise the rest pose decides. Skeletons with fewer than
/// ten joints are not checked.
Findings judge_size(const BvhHierarchy& hierarchy, const Skeleton& skeleton,
                    std::span<const double> rows, const BvhOptions& options, std::string_view name);

/// Converts rows of channel values [n,C] to local positions and rotations, and appends these to
/// `out`. Position channels replace the components of OFFSET. Angles apply in the order of the
/// channels. Between calls, only the number of frames is kept, because the stamps depend on it.
class BvhPoser {
 public:
  BvhPoser(const BvhHierarchy& hierarchy, const BvhOptions& options);
  void append(std::span<const double> values, ClipFrames& out);
  std::uint64_t frames() const { return frames_; }

 private:
  struct Joint {
    std::array<int, 3> position{-1, -1, -1};  // column of x, y, z; -1: none, OFFSET is used
    // The columns of the first, second and third rotation; -1: no column, the angle is zero.
    std::array<int, 3> angle{-1, -1, -1};
    EulerOrder order;
    Vec3 offset = Vec3::Zero();  // m, in the file's axes
    bool root = false;
  };
  void place(const Joint& joint, std::span<const double> values, std::span<double> positions) const;
  void turn(const Joint& joint, std::span<const double> values, std::span<double> rotations) const;

  // [J] in the order of the hierarchy.
  std::vector<Joint> joints_;
  std::size_t row_size_ = 0;
  BvhOptions options_;
  double frame_ns_ = 0.0;
  std::uint64_t frames_ = 0;
};

/// Makes a reader that takes the file in pieces (formats/reader.h). The reader counts values and
/// not lines. A wrong frame count or an incomplete last frame is a finding. However, if each of the
/// first frames is one line, a line with a wrong number of values is an error, because it shifts
/// all following frames.
std::unique_ptr<ClipReader> make_bvh_reader(const BvhOptions& options, const std::string& name);

/// Reads a whole file. `name` appears in messages only. The memory depends on the number of values
/// in the text.
Result<BvhFile> read_bvh(std::string_view text, std::string_view name, const BvhOptions& options);

/// The first pass over a file: its hash, its skeleton and its number of frames. Usually it only
/// counts words. It parses the numbers if the count of words does not fit the stated number of
/// frames, or if the file ends within its last word.
Result<ClipSurvey> survey_bvh(FileSystem& files, const std::string& path, const BvhOptions& options,
                              const Progress& progress);

/// Writes `values` with the file's number of decimals. After reading the result again, every
/// channel has exactly the same value. For a clip from another source, bvh_from_clip() first makes
/// channels. For files larger than memory, use BvhWriter and copy_bvh().
Result<void> write_bvh(const BvhFile& file, const FileSink& sink);

/// Makes a BVH file from a clip of another source, with the channels of BvhChannels.
BvhFile bvh_from_clip(Clip clip, double frame_seconds);

/// Writes a BVH file block by block. The number of frames must be known before the first block,
/// because "Frames:" stands above the rows.
class BvhWriter {
 public:
  BvhWriter(const BvhHierarchy& hierarchy, std::uint64_t frames, int decimals, FileSink sink);

  /// Appends the next rows of channel values [n,C].
  Result<void> append(std::span<const double> values);
  /// Fails if the number of rows differs from the number of frames in the head.
  Result<void> finish();

 private:
  FileSink sink_;
  std::size_t row_size_;
  int decimals_;
  std::uint64_t frames_, written_ = 0;
  std::string text_;  // text that was not passed to the sink yet
};

/// Makes channels for a clip of another source: centimetres, y up, rotations Z X Y, six decimals.
/// Roots get position channels. Other joints get them if they move by more than a micrometre from
/// their offset, or if all joints shall have them, as in the files of motion suits. Joints are in
/// the order in which a BVH file nests them.
class BvhChannels {
 public:
  enum class Positions { of_what_moves, of_all };
  explicit BvhChannels(const Skeleton& skeleton, Positions positions = Positions::of_what_moves);

  /// First pass: takes the local positions [n,J,3] of all frames, in blocks, and finds the joints
  /// that move.
  void see(std::span<const double> local_positions);
  BvhHierarchy hierarchy(std::uint64_t frames, double frame_seconds) const;

  /// Second pass: converts local positions [n,J,3] and rotations [n,J,4] to rows [n,C], and appends
  /// the rows to `values`.
  void append(std::span<const double> local_positions, std::span<const double> local_rotations,
              std::vector<double>& values) const;

 private:
  // A root always has position channels; otherwise it would stay at the origin.
  bool has_position(std::size_t j) const { return moves_[j] || skeleton_.parents[j] < 0; }

  Skeleton skeleton_;
  std::vector<std::size_t> order_;  // [J] indices into the skeleton, in the order of the file
  std::vector<bool> moves_;         // [J] true: the joint moves away from its offset
};

/// Copies a BVH file with its own channels, values and decimals; every number stays the same. Reads
/// the file twice in pieces, because the number of frames is known only after the first pass.
/// Returns the findings about the rows.
Result<Findings> copy_bvh(FileSystem& files, const std::string& from, const FileSink& sink,
                          const Progress& progress = {});

}  // namespace kinalign
