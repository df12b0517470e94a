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

/// A BVH states none of these, so they come from the manifest or are defaults.
struct BvhOptions {
  double metres_per_unit = 0.01;  // most writers, Axis Neuron among them, use centimetres
  bool z_up = false;              // the file's up axis is z; y otherwise
  Time start{};                   // stamp of frame 0; the file itself has none
};

/// The options of a BVH for a stream. The click's latency is added to the start stamp.
BvhOptions bvh_options(const StreamOptions& options);

/// One channel of a joint: 0..2 position x, y, z; 3..5 rotation about x, y, z.
using Channel = std::uint8_t;

/// The hierarchy above the rows, in the file's own units and names.
/// Values are kept as written, so that writing gives the same text again.
struct BvhHierarchy {
  std::vector<std::string> names;              // [J] as written; may repeat
  std::vector<int> parents;                    // [J] -1: a root
  std::vector<Vec3> offsets;                   // [J]
  std::vector<std::vector<Channel>> channels;  // [J] in the order of the row
  std::vector<EndSite> end_sites;
  int offset_decimals = 6;       // digits behind the point of the OFFSETs
  std::uint64_t frames = 0;      // number stated in the file; the rows decide
  std::int64_t frames_line = 0;  // line of "Frames:", from 1
  double frame_seconds = 0.0;
  std::string frame_time;  // text of the number in the file

  std::size_t row_size() const;  // values in a frame, C
};

/// A whole BVH in memory. The clip and the values hold the same motion: the clip for computing, the
/// values for writing.
struct BvhFile {
  BvhHierarchy hierarchy;
  Clip clip;                   // T frames, J joints; repeated names are name#2, name#3, ...
  std::vector<double> values;  // [T,C] as read: the file's units, degrees, beyond +-180 too
  int decimals = 6;            // decimals of the file's values, for writing
  Findings findings;  // faults that did not stop the reading: "Frames: 900" above 899 rows, ...
};

/// Parses everything above the rows. `text` must reach to the end of the "Frame Time:" number. Sets
/// `rows` to the position of the first row. Fails if the hierarchy can't be understood.
/// Survey, reader and copy share this parser, so they agree on every file.
Result<BvhHierarchy> parse_bvh_hierarchy(std::string_view text, std::string_view name,
                                         std::size_t& rows, Findings& findings);

/// True if the first word is "HIERARCHY".
bool looks_like_bvh(std::string_view head);

/// The skeleton in metres. Repeated names become name#2, name#3, ..., with a finding.
Skeleton skeleton_of(const BvhHierarchy& hierarchy, const BvhOptions& options,
                     std::string_view name, Findings& findings);

/// Checks that a person's skeleton has a person's size and stands upright; a finding proposes
/// another metres_per_unit or another up axis. If the first of `rows` [n,C] shows clearly which
/// axis is up, it decides; otherwise, or without rows, the rest pose decides. Skeletons with fewer
/// than ten joints are not judged.
Findings judge_size(const BvhHierarchy& hierarchy, const Skeleton& skeleton,
                    std::span<const double> rows, const BvhOptions& options, std::string_view name);

/// Converts rows of channel values [n,C] into local positions and rotations, which it appends to
/// `out`. Position channels replace the components of OFFSET. Angles apply in the order of the
/// channels.
/// Knows the column of each channel and appends block after block. Only the number of frames is
/// kept between calls, for the stamps.
class BvhPoser {
 public:
  BvhPoser(const BvhHierarchy& hierarchy, const BvhOptions& options);
  void append(std::span<const double> values, ClipFrames& out);
  std::uint64_t frames() const { return frames_; }

 private:
  struct Joint {
    std::array<int, 3> position{-1, -1, -1};  // column of x, y, z; -1: none, the offset applies
    // Column of the first, second and third rotation; -1: none, the angle is zero.
    std::array<int, 3> angle{-1, -1, -1};
    EulerOrder order;
    Vec3 offset = Vec3::Zero();  // m, in the file's axes
    bool root = false;
  };
  void place(const Joint& joint, std::span<const double> values, std::span<double> positions) const;
  void turn(const Joint& joint, std::span<const double> values, std::span<double> rotations) const;

  // joints_ is [J], in the order of the hierarchy.
  std::vector<Joint> joints_;
  std::size_t row_size_ = 0;
  BvhOptions options_;
  double frame_ns_ = 0.0;
  std::uint64_t frames_ = 0;
};

/// A reader that takes the file in pieces (reader.h). It counts values, not lines: a wrong frame
/// count or an incomplete last frame is a finding. If each of the first frames stands on one line,
/// however, a line that shifts the following frames is an error.
std::unique_ptr<ClipReader> make_bvh_reader(const BvhOptions& options, const std::string& name);

/// Reads a whole file. `name` appears in messages only. Memory use depends on the values that are
/// present.
Result<BvhFile> read_bvh(std::string_view text, std::string_view name, const BvhOptions& options);

/// The first pass over a file: its hash, its skeleton and its number of frames. It parses the
/// numbers only if the word count does not fit the promised number of frames, or if the file ends
/// within its last word.
Result<ClipSurvey> survey_bvh(FileSystem& files, const std::string& path, const BvhOptions& options,
                              const Progress& progress);

/// Writes `values` with the file's number of decimals: read, write, read gives every channel
/// exactly. A clip from elsewhere first gets its channels from bvh_from_clip(). For files larger
/// than memory there are BvhWriter and copy_bvh().
Result<void> write_bvh(const BvhFile& file, const FileSink& sink);

/// Makes a BVH from a clip of another source, with the channels of BvhChannels.
BvhFile bvh_from_clip(Clip clip, double frame_seconds);

/// Writes a BVH block by block. The number of frames must be known before the first block.
/// "Frames:" stands above the rows, and a stream can't be written twice.
class BvhWriter {
 public:
  BvhWriter(const BvhHierarchy& hierarchy, std::uint64_t frames, int decimals, FileSink sink);

  /// The next rows of channel values [n,C].
  Result<void> append(std::span<const double> values);
  /// Fails if the number of rows differs from the promised number of frames.
  Result<void> finish();

 private:
  FileSink sink_;
  std::size_t row_size_;
  int decimals_;
  std::uint64_t frames_, written_ = 0;
  std::string text_;  // text that the sink has not received yet
};

/// Makes channels for a clip of another source: centimetres, y up, rotations Z X Y, six decimals.
/// Roots get position channels, and so do joints that leave their offset by more than a micrometre,
/// or all joints, as motion suits write them. Joints come in the order in which a BVH nests them.
class BvhChannels {
 public:
  enum class Positions { of_what_moves, of_all };
  explicit BvhChannels(const Skeleton& skeleton, Positions positions = Positions::of_what_moves);

  /// First pass: takes the local positions [n,J,3] of all frames, in blocks, to find the joints
  /// that move.
  void see(std::span<const double> local_positions);
  BvhHierarchy hierarchy(std::uint64_t frames, double frame_seconds) const;

  /// Second pass: converts local positions [n,J,3] and rotations [n,J,4] to rows [n,C], which it
  /// appends to `values`.
  void append(std::span<const double> local_positions, std::span<const double> local_rotations,
              std::vector<double>& values) const;

 private:
  // A root without position channels would stay at the origin.
  bool has_position(std::size_t j) const { return moves_[j] || skeleton_.parents[j] < 0; }

  Skeleton skeleton_;
  std::vector<std::size_t> order_;  // [J] the skeleton's joints in the order of writing
  std::vector<bool> moves_;         // [J] true: the joint leaves its offset
};

/// Copies a BVH with its own channels, values and decimals; every number stays as it is. Reads the
/// file twice in pieces, because the number of frames is known only after the first pass. Returns
/// the findings about its rows.
Result<Findings> copy_bvh(FileSystem& files, const std::string& from, const FileSink& sink,
                          const Progress& progress = {});

}  // namespace kinalign
