// SPDX-License-Identifier: Apache-2.0
// Imports NTU RGB+D. A name S001C002P003R001A004.skeleton states setup, camera, person, repetition
// and action.
#include "kinalign/dataset/import/corpora.h"
#include "kinalign/dataset/import/file_names.h"
#include "kinalign/formats/points/ntu_skeleton.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace kinalign {

namespace {

/// The numbers of a clip's name.
struct ClipName {
  std::uint32_t setup = 0, camera = 0, person = 0, repetition = 0, action = 0;

  /// Each clip of a person's action has another run: 1712 is setup 17, camera 1, repetition 2.
  std::uint32_t run() const { return 100 * setup + 10 * camera + repetition; }
  /// True for actions of two people (rose1.ntu.edu.sg); the second person has no number.
  bool is_mutual() const { return (action >= 50 && action <= 60) || action >= 106; }
  // The classes are those of the corpus's list of actions.
  std::string_view class_id() const {
    if (is_mutual()) return "mutual";
    return (action >= 41 && action <= 49) || action >= 103 ? "medical" : "daily";
  }
};

/// The numbers in a clip's file name; absent if the name is not of the form
/// S001C002P003R001A004.skeleton.
std::optional<ClipName> clip_of(std::string_view name) {
  ClipName out;
  std::string_view rest = stem_of(name);
  const bool fits =
      has_ending(name, ".skeleton") && take_digits(rest, "S", 3, out.setup) &&
      take_digits(rest, "C", 3, out.camera) && take_digits(rest, "P", 3, out.person) &&
      take_digits(rest, "R", 3, out.repetition) && take_digits(rest, "A", 3, out.action);
  return fits && rest.empty() ? std::optional(out) : std::nullopt;
}

/// The manifest of a clip: the body that is seen longest, and for actions of two people also the
/// second one. `bodies` are sorted by the time for which they are seen.
Manifest clip_manifest(const std::string& path, const std::vector<NtuBody>& bodies,
                       bool is_mutual) {
  Manifest out;
  // Bodies that were seen for a shorter time are left out.
  const std::size_t count = is_mutual ? std::min<std::size_t>(bodies.size(), 2) : 1;
  for (std::size_t k = 0; k < count; ++k) {
    out.streams.push_back(stream_of(k == 0 ? "kinect" : "partner", path, "ntu"));
    out.streams.back().select = {{"body", bodies[k].id}};
  }
  if (count == 2) out.streams.back().clock = "shared";  // both are rows of one file
  return out;
}

/// Lists each clip as a take. Clips without a skeleton are left out.
Result<Corpus> list_ntu(const ImportInput& input) {
  Corpus out{.name = "NTU RGB+D",
             .licence = "for academic research alone, by agreement with ROSE Lab",
             .citation =
                 "A. Shahroudy, J. Liu, T.-T. Ng, G. Wang: NTU RGB+D. CVPR 2016; J. Liu et "
                 "al.: NTU RGB+D 120. TPAMI 2019",
             .classes = {{"daily", "daily actions"},
                         {"medical", "medical conditions"},
                         {"mutual", "actions of two people"}},
             .class_id = "daily"};
  for (const SourceFile& file : input.sources) {
    const auto clip = clip_of(file.name);
    if (!clip) continue;
    const std::string stem(stem_of(file.name)), action = fmt::format("A{:03}", clip->action);
    InputFile opened = KA_TRY(InputFile::open(input.files, file.path));
    // All bodies are read to find out which one is seen longest.
    const auto bodies = KA_TRY(ntu_bodies([&opened] { return opened.next(); }, file.path));
    // The user can stop the import after each clip.
    if (!go_on(input.progress, "reading", out.takes.size(), input.sources.size())) {
      return Failure(interruption(file.path));
    }
    if (bodies.empty()) {
      out.left_out.push_back({stem, "without a skeleton"});
      continue;
    }
    out.takes.push_back({fmt::format("{:03}", clip->person), action, clip->run(),
                         clip_manifest(file.path, bodies, clip->is_mutual()), stem});
    // The files state numbers of actions, but no names.
    if (find_id(out.actions, action) == nullptr) {
      out.actions.push_back({action, std::string(clip->class_id()), ""});
    }
  }
  return out;
}

}  // namespace

CorpusKind ntu_corpus() {
  return {"ntu", "S001C001P001R001A001.skeleton", false,
          [](FileSystem&, const SourceFile& file) { return clip_of(file.name).has_value(); },
          list_ntu};
}

}  // namespace kinalign
