// SPDX-License-Identifier: Apache-2.0
// Imports UI-PRMD as pairs for learning, by the corpus's protocol (docs/dataset_import.md). Joint
// centres come from the markers, and the time shift of each repetition from a search. One rigid
// transform is fitted for all repetitions of a person's movement. Repetitions that fit badly are
// left out.
#include "kinalign/core/hash.h"
#include "kinalign/core/parallel.h"
#include "kinalign/core/text_out.h"
#include "kinalign/dataset/import/corpora.h"
#include "kinalign/dataset/import/new_folder.h"
#include "kinalign/dataset/import/ui_prmd.h"
#include "kinalign/formats/points/trc.h"
#include "kinalign/motion/pairs/plug_in_gait.h"
#include "kinalign/motion/pairs/shift_search.h"
#include "kinalign/sources/open_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace kinalign {

namespace {

// The rates of the protocol.
constexpr double kinect_hz = 30.0, truth_hz = 50.0;
constexpr double most_rms_m = 0.12;     // largest rms of an accepted repetition
constexpr std::size_t least_taken = 3;  // least accepted repetitions of a person's movement
// Elbows and knees are fitted to one of this many frames of the truth.
constexpr std::size_t shift_stride = 5;
constexpr double gap_ms = 36.0;  // more than a step of the Kinect, less than two of the truth
constexpr std::size_t marker_count = plug_in_gait_markers.size();

/// One repetition. The markers are dropped once the joints are computed.
struct Repetition {
  PieceName name;
  PiecePair files;
  std::string sha256;                // hash of the files' hashes
  std::vector<double> kinect;        // [F,18,3] m, the joints in F frames
  std::vector<double> markers;       // [G,39,3] m, in G frames at 50 Hz
  std::vector<std::uint8_t> seen;    // [G,39] 1: the marker was seen
  JointCentres truth;                // G frames of joints
  std::optional<FoundShift> found;   // absent: too little overlap
  RigidTransform kinect_from_truth;  // the same for all repetitions of a person's movement

  PointPiece rough() const { return {kinect, {}, shared_joint_count, kinect_hz}; }
  PointPiece precise() const {
    return {truth.positions, truth.valid, shared_joint_count, truth_hz};
  }
  bool fits() const { return found && found->rms_m <= most_rms_m; }
};

/// All frames of a stream, in memory.
Result<PointFrames> all_frames(const PointInput& points) {
  PointFrames out, block;
  auto pass = KA_TRY(points.passes());
  while (KA_TRY(pass(block))) {
    out.positions.insert(out.positions.end(), block.positions.begin(), block.positions.end());
    out.state.insert(out.state.end(), block.state.begin(), block.state.end());
    out.stamps.insert(out.stamps.end(), block.stamps.begin(), block.stamps.end());
  }
  return out;
}

/// Reads the 18 joints that Kinect and markers have in common (motion/shared_joints.h).
Result<void> read_kinect(const PointInput& points, Repetition& out) {
  // The corpus's layout has all shared joints, so a missing one is an error.
  const auto joints = KA_TRY(shared_joints_among(points.joint_names));
  const PointFrames frames = KA_TRY(all_frames(points));
  out.kinect.resize(3 * shared_joint_count * frames.size());
  for (std::size_t t = 0; t < frames.size(); ++t) {
    for (std::size_t j = 0; j < shared_joint_count; ++j) {
      vec3(out.kinect, t * shared_joint_count + j) =
          vec3(frames.positions, t * points.joint_names.size() + joints[j]);
    }
  }
  return {};
}

/// Reads the markers. Of 100 Hz only every second frame is used, because packs contain only those.
Result<void> read_markers(const PointInput& points, Repetition& out) {
  const PointFrames frames = KA_TRY(all_frames(points));
  // Thus text files and packs give the same joints.
  const std::size_t stride = out.files.vicon_hz > truth_hz ? 2 : 1;
  for (std::size_t t = 0; t < frames.size(); t += stride) {
    for (std::size_t i = t * marker_count; i < (t + 1) * marker_count; ++i) {
      const Vec3 place = vec3(frames.positions, i);
      out.markers.insert(out.markers.end(), place.begin(), place.end());
      out.seen.push_back(frames.state[i] == Tracking::missing ? 0 : 1);
    }
  }
  return {};
}

/// Reads both devices of a repetition, and hashes their files.
Result<Repetition> read_repetition(FileSystem& files, const PieceName& name,
                                   const PiecePair& pair) {
  Repetition out;
  out.name = name;
  out.files = pair;
  const Recording recording =
      KA_TRY(open_streams(files, {kinect_stream_of(pair), marker_stream_of(pair)}));
  Sha256 hash;
  for (const RecordedStream& stream : recording.streams) {
    for (const InputFacts& facts : stream.files) hash.update(facts.sha256);
  }
  out.sha256 = hash.hex();
  KA_TRY(read_kinect(std::get<PointInput>(recording.streams[0].data), out));
  KA_TRY(read_markers(std::get<PointInput>(recording.streams[1].data), out));
  return out;
}

/// Computes the joints of all repetitions of one person. These share the body's size and the places
/// of the markers.
void put_truth(std::vector<Repetition>& all) {
  std::vector<double> places, few_places;
  std::vector<std::uint8_t> seen, few_seen;
  for (const Repetition& one : all) {
    places.insert(places.end(), one.markers.begin(), one.markers.end());
    seen.insert(seen.end(), one.seen.begin(), one.seen.end());
  }
  for (std::size_t i = 0; i < seen.size(); ++i) {
    // Elbows and knees are fitted to a fifth of the frames.
    if (i / marker_count % shift_stride != 0) continue;
    few_seen.push_back(seen[i]);
    few_places.insert(few_places.end(), &places[3 * i], &places[3 * i] + 3);
  }
  const JointCentres joints =
      joint_centres({places, seen}, functional_shifts({few_places, few_seen}));
  auto place = joints.positions.begin();
  auto valid = joints.valid.begin();
  for (Repetition& one : all) {
    const auto cells =
        static_cast<std::ptrdiff_t>(one.seen.size() / marker_count * shared_joint_count);
    one.truth = {{place, place + 3 * cells}, {valid, valid + cells}};
    place += 3 * cells;
    valid += cells;
    // Invalid joints are interpolated, so that a spline can be fitted. They remain marked as
    // invalid.
    fill_invalid(one.truth);
    one.markers = {};
    one.seen = {};
  }
}

/// The repetitions of one person, either all correct or all wrong ones.
using Group = std::vector<std::pair<PieceName, PiecePair>>;

/// All repetitions of one person, with their joints and time shifts.
Result<std::vector<Repetition>> read_person(const ImportInput& input, const Group& group) {
  // Each thread fills its own element, so the order is that of the group.
  std::vector<Result<Repetition>> read(group.size());
  parallel_for(group.size(), input.jobs, [&](std::size_t i) {
    read[i] = read_repetition(input.files, group[i].first, group[i].second);
  });
  std::vector<Repetition> out;
  out.reserve(read.size());
  // If several repetitions failed, the first one in the order of the group is reported.
  for (auto& one : read) out.push_back(KA_TRY(std::move(one)));
  put_truth(out);
  parallel_for(out.size(), input.jobs, [&](std::size_t i) {
    out[i].found = find_shift(out[i].rough(), PieceCurve(out[i].precise()));
  });
  return out;
}

/// Decides about the repetitions of one person's movement: accepted ones are moved to `taken`, the
/// others are noted with the reason.
void pass_gate(std::vector<Repetition> movement, std::vector<Repetition>& taken, Corpus& corpus) {
  // A movement needs several accepted repetitions (least_taken).
  const auto fitting = static_cast<std::size_t>(std::count_if(
      movement.begin(), movement.end(), [](const Repetition& one) { return one.fits(); }));
  for (Repetition& one : movement) {
    const std::string rms =
        one.found ? fmt::format("{} ({:.1f} cm)", one.name.text(), 100.0 * one.found->rms_m)
                  : one.name.text();
    if (!one.found) {
      corpus.left_out.push_back({rms, "Kinect and Vicon overlap in less than five frames"});
    } else if (!one.fits()) {
      corpus.left_out.push_back({rms, "rms of the rigid fit above 12 cm"});
    } else if (fitting < least_taken) {
      corpus.left_out.push_back({rms, "fewer than 3 repetitions of the movement within 12 cm"});
    } else {
      taken.push_back(std::move(one));
    }
  }
}

/// Fits one transform for all repetitions of the movement.
Result<void> put_transform(std::span<Repetition> movement) {
  // The sums of all repetitions are used, because one transform is fitted for the whole movement.
  PairMoments moments;
  for (const Repetition& one : movement) {
    add_pairs_at(one.rough(), PieceCurve(one.precise()), one.found->shift_s, moments);
  }
  const RigidTransform transform = KA_TRY(fit_rigid(moments));
  for (Repetition& one : movement) one.kinect_from_truth = transform;
  return {};
}

/// The accepted repetitions of one person, with their transforms.
Result<std::vector<Repetition>> take_person(std::vector<Repetition> all, Corpus& corpus) {
  std::vector<Repetition> taken;
  for (auto begin = all.begin(); begin != all.end();) {
    const auto end = std::find_if(begin, all.end(), [&](const Repetition& one) {
      // The repetitions are sorted by movement, so the repetitions of one movement follow each
      // other.
      return one.name.movement != begin->name.movement;
    });
    // The accepted repetitions of this movement are added after this index.
    const std::size_t before = taken.size();
    pass_gate({std::make_move_iterator(begin), std::make_move_iterator(end)}, taken, corpus);
    if (taken.size() > before) KA_TRY(put_transform(std::span(taken).subspan(before)));
    begin = end;
  }
  return taken;
}

std::string truth_name(const Repetition& one) { return one.name.text() + "_joints.trc"; }

/// The truth from the first to the last frame with a valid joint.
PointFrames truth_frames(const Repetition& one) {
  const auto is_valid = [](std::uint8_t valid) { return valid != 0; };
  const auto& valid = one.truth.valid;
  const auto first = std::find_if(valid.begin(), valid.end(), is_valid) - valid.begin();
  const auto behind = valid.rend() - std::find_if(valid.rbegin(), valid.rend(), is_valid);
  const std::size_t begin = static_cast<std::size_t>(first) / shared_joint_count;
  // Frames without a valid joint are cut off at both ends. Between them they stay, as missing.
  const std::size_t end =
      (static_cast<std::size_t>(behind) + shared_joint_count - 1) / shared_joint_count;
  PointFrames out;
  for (std::size_t t = begin; t < end; ++t) {
    out.stamps.push_back(utc_time(static_cast<std::int64_t>(t) * 20'000'000));  // 50 Hz
    for (std::size_t i = t * shared_joint_count; i < (t + 1) * shared_joint_count; ++i) {
      const bool is_there = valid[i] != 0;
      const Vec3 place = is_there ? Vec3(vec3(one.truth.positions, i)) : Vec3::Zero();
      out.positions.insert(out.positions.end(), place.begin(), place.end());
      out.state.push_back(is_there ? Tracking::tracked : Tracking::missing);
    }
  }
  return out;
}

/// Writes the truth of a repetition.
Result<void> write_truth(const Repetition& one, const PutFile& put) {
  const PointFrames frames = truth_frames(one);
  TextOut out(KA_TRY(put(truth_name(one))));
  TrcWriter writer = KA_TRY(TrcWriter::begin({{shared_joints.begin(), shared_joints.end()},
                                              truth_hz,
                                              frames.size(),
                                              truth_name(one),
                                              Time{}},
                                             out));
  KA_TRY(writer.append(frames));
  KA_TRY(writer.finish());
  return out.commit();
}

/// The folder with one person's files of joints. If it does not exist, it is made. Its name
/// contains a hash of all files of the person, because each file influences every joint.
Result<std::string> truth_folder(const ImportInput& input, const std::string& sha256,
                                 const std::vector<Repetition>& taken) {
  const std::string stem = fmt::format("s{}joints", taken.front().name.person());
  return filled_folder(input.files, input.raw_folder, stem, sha256,
                       [&](const PutFile& put) -> Result<void> {
                         for (const Repetition& one : taken) KA_TRY(write_truth(one, put));
                         return {};
                       });
}

Manifest manifest_of(const Repetition& one, const std::string& folder) {
  Manifest out;
  // The grid of these takes is that of the Kinect's frames.
  out.align.reference = "kinect";
  out.align.gap_ms = gap_ms;
  out.streams = {kinect_stream_of(one.files),
                 stream_of("mocap", folder + "/" + truth_name(one), "trc")};
  // Kinect frame i is at the time shift + i / 30 of the truth.
  out.streams.back().offset_ms = -1000.0 * one.found->shift_s;
  SpaceOptions& space = out.spaces["mocap"];
  space.method = "given";
  const Quat& turn = one.kinect_from_truth.rotation;
  const Vec3& move = one.kinect_from_truth.translation;
  space.rotation = {turn.w(), turn.x(), turn.y(), turn.z()};
  space.translation = {move.x(), move.y(), move.z()};
  for (std::size_t j = 0; j < shared_joint_count; ++j) {
    space.joints.emplace(shared_joints[j], shared_joints_in_ui_prmd[j]);
  }
  return out;
}

/// Adds the accepted repetitions of one person to the corpus.
Result<void> add_person(const ImportInput& input, const Group& group, Corpus& corpus) {
  std::vector<Repetition> all = KA_TRY(read_person(input, group));
  Sha256 hash;
  // The hash also covers repetitions that are not accepted, because they influence the joints.
  for (const Repetition& one : all) hash.update(one.sha256);
  const auto taken = KA_TRY(take_person(std::move(all), corpus));
  // No file of joints is written for a person without an accepted repetition.
  if (taken.empty()) return {};
  const std::string folder = KA_TRY(truth_folder(input, hash.hex(), taken));
  for (const Repetition& one : taken) {
    corpus.takes.push_back({one.name.person(), one.name.action(), one.name.repetition,
                            manifest_of(one, folder), one.name.text()});
  }
  return {};
}

Result<Corpus> list_ui_prmd_joints(const ImportInput& input) {
  Corpus out = ui_prmd_without_takes();
  PiecePairs pairs = KA_TRY(find_ui_prmd_pairs(input));
  leave_out_single(pairs, out);
  // Each person is read as a whole, because all repetitions share the body's size.
  std::map<std::pair<std::uint32_t, bool>, Group> people;  // wrong repetitions are a separate group
  for (auto& pair : pairs) {
    people[{pair.first.subject, pair.first.incorrect}].emplace_back(std::move(pair));
  }
  std::size_t done = 0;
  for (const auto& [person, group] : people) {
    KA_TRY(add_person(input, group, out));
    if (!go_on(input.progress, "pairing", ++done, people.size())) return Failure(interruption());
  }
  return out;
}

}  // namespace

CorpusKind ui_prmd_joints_corpus() {
  return {"ui-prmd-joints", "the files of ui-prmd, with --from", false,
          [](FileSystem&, const SourceFile&) { return false; }, list_ui_prmd_joints};
}

}  // namespace kinalign
