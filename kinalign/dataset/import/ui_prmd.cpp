// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/import/ui_prmd.h"

#include "kinalign/dataset/import/corpora.h"
#include "kinalign/dataset/import/file_names.h"
#include "kinalign/dataset/import/new_folder.h"
#include "kinalign/dataset/import/ui_prmd_pieces.h"

#include <fmt/format.h>

#include <array>
#include <optional>

namespace kinalign {

namespace {

// The names of the movements, in the order of their numbers.
constexpr std::array<std::string_view, 10> movements{"deep squat",
                                                     "hurdle step",
                                                     "inline lunge",
                                                     "side lunge",
                                                     "sit to stand",
                                                     "standing active straight leg raise",
                                                     "standing shoulder abduction",
                                                     "standing shoulder extension",
                                                     "standing shoulder internal-external rotation",
                                                     "standing shoulder scaption"};

/// The movement, person and repetition in a file's name; absent if the name has another form.
std::optional<PieceName> piece_of(std::string_view name) {
  PieceName out;
  std::string_view rest = stem_of(name);
  if (!has_ending(name, ".txt") || !take_digits(rest, "m", 2, out.movement) ||
      !take_digits(rest, "_s", 2, out.subject) || !take_digits(rest, "_e", 2, out.repetition)) {
    return std::nullopt;
  }
  out.incorrect = rest == "_positions_inc";
  return out.incorrect || rest == "_positions" ? std::optional(out) : std::nullopt;
}

/// True for a pack, which has all repetitions of one person: "s01.npz".
bool is_piece_pack(const SourceFile& file) {
  std::string_view stem = stem_of(file.name);
  std::uint32_t number = 0;
  return has_ending(file.name, ".npz") && take_digits(stem, "s", 2, number) && stem.empty();
}

/// Adds the text files of both devices in pairs. Files of whole movements are skipped, because the
/// repetitions were cut from them.
void add_texts(const std::vector<SourceFile>& sources, double vicon_hz, PiecePairs& out) {
  for (const SourceFile& file : sources) {
    const auto piece = piece_of(file.name);
    if (!piece) continue;
    // Both devices have files of the same name, so the folder decides to which device a file
    // belongs.
    const bool is_kinect = file.path.find("/Kinect/") != std::string::npos;
    const bool is_vicon = file.path.find("/Vicon/") != std::string::npos;
    // A file outside of both folders belongs to no device.
    if (is_kinect == is_vicon) continue;
    PiecePair& pair = out[*piece];
    std::string& path = is_kinect ? pair.kinect : pair.vicon;
    // If a repetition has several files, the first one is used.
    if (!path.empty()) continue;
    path = file.path;
    if (is_vicon) pair.vicon_hz = vicon_hz;
  }
}

/// Adds the pairs of packs. A pack is first unpacked to text files, which are then read as above.
Result<void> add_packs(const ImportInput& input, PiecePairs& out) {
  for (const SourceFile& file : input.sources) {
    if (!is_piece_pack(file)) continue;
    const std::string folder = KA_TRY(unpacked_folder(
        input.files, input.raw_folder, file.path, [&](const PutFile& put) -> Result<void> {
          return write_ui_prmd_pieces(KA_TRY(archive_bytes(input.files, file.path)),
                                      std::string(stem_of(file.name)), put);
        }));
    PiecePairs packed;
    add_texts(KA_TRY(list_sources(input.files, {folder}, input.raw_folder, input.progress)), 50.0,
              packed);
    out.merge(packed);  // a repetition that exists as a text file keeps that file
  }
  return {};
}

/// The manifest of a pair. The Kinect is fitted to the markers.
Manifest pair_manifest(const PiecePair& pair) {
  Manifest out;
  out.streams = {marker_stream_of(pair), kinect_stream_of(pair)};
  SpaceOptions& space = out.spaces["kinect"];
  space.method = "fit";
  // For each joint the nearest marker on the skin, in pairs left and right.
  space.joints = {{"UpperArmLeft", "LSHO"}, {"UpperArmRight", "RSHO"}, {"ForearmLeft", "LELB"},
                  {"ForearmRight", "RELB"}, {"HandLeft", "LWRA"},      {"HandRight", "RWRA"},
                  {"LowerLegLeft", "LKNE"}, {"LowerLegRight", "RKNE"}, {"FootLeft", "LANK"},
                  {"FootRight", "RANK"}};
  return out;
}

/// Each pair of files is a take.
Result<Corpus> list_ui_prmd(const ImportInput& input) {
  Corpus out = ui_prmd_without_takes();
  PiecePairs pairs = KA_TRY(find_ui_prmd_pairs(input));
  leave_out_single(pairs, out);
  for (const auto& [piece, pair] : pairs) {
    out.takes.push_back(
        {piece.person(), piece.action(), piece.repetition, pair_manifest(pair), piece.text()});
  }
  return out;
}

}  // namespace

std::string PieceName::action() const {
  return fmt::format("m{:02}{}", movement, incorrect ? "inc" : "");
}

std::string PieceName::person() const { return fmt::format("{:02}", subject); }

std::string PieceName::text() const {
  return fmt::format("m{:02}_s{:02}_e{:02}{}", movement, subject, repetition,
                     incorrect ? "_inc" : "");
}

Result<PiecePairs> find_ui_prmd_pairs(const ImportInput& input) {
  PiecePairs pairs;
  // Text files come first, because they have the full rate of the markers.
  add_texts(input.sources, 100.0, pairs);
  KA_TRY(add_packs(input, pairs));
  return pairs;
}

StreamOptions kinect_stream_of(const PiecePair& pair) {
  return stream_of("kinect", pair.kinect, "ui_prmd_kinect");
}

StreamOptions marker_stream_of(const PiecePair& pair) {
  StreamOptions out = stream_of("mocap", pair.vicon, "ui_prmd_vicon");
  // The layout states the rate of the source, 100 Hz; packs have half of it.
  if (pair.vicon_hz != 100.0) out.rate_hz = pair.vicon_hz;
  return out;
}

Corpus ui_prmd_without_takes() {
  Corpus out{.name = "UI-PRMD",
             .licence = "ODC PDDL 1.0",
             .citation =
                 "A. Vakanski, H. Jun, D. Paul, R. Baker: A Data Set of Human Body Movements "
                 "for Physical Rehabilitation Exercises. Data 2018, 3(1), 2",
             .classes = {{"uiprmd", "movements of rehabilitation"},
                         {"uiprmdinc", "movements of rehabilitation, done wrongly on purpose"}},
             .class_id = "uiprmd"};
  // Each movement is two actions: done correctly, and done wrongly on purpose.
  for (std::size_t k = 0; k < movements.size(); ++k) {
    const std::string id = fmt::format("m{:02}", k + 1), name(movements[k]);
    out.actions.push_back({id, "uiprmd", name});
    out.actions.push_back({id + "inc", "uiprmdinc", name + ", done wrongly"});
  }
  return out;
}

void leave_out_single(PiecePairs& pairs, Corpus& corpus) {
  for (auto at = pairs.begin(); at != pairs.end();) {
    const PiecePair& pair = at->second;
    const bool whole = !pair.kinect.empty() && !pair.vicon.empty();
    if (!whole) {
      corpus.left_out.push_back(
          {at->first.text(), pair.vicon.empty() ? "without Vicon" : "without Kinect"});
    }
    at = whole ? std::next(at) : pairs.erase(at);
  }
}

CorpusKind ui_prmd_corpus() {
  return {"ui-prmd", "Kinect/Positions/m01_s01_e01_positions.txt, s01.npz", false,
          [](FileSystem&, const SourceFile& file) {
            return is_piece_pack(file) || piece_of(file.name).has_value();
          },
          list_ui_prmd};
}

}  // namespace kinalign
