// SPDX-License-Identifier: Apache-2.0
// Imports NTU RGB+D: S001C002P003R001A004.skeleton is setup, camera, person, repetition and action.
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

  /// Unique for each clip of a person's action: 1712 is setup 17, camera 1, repetition 2.
  std::uint32_t run() const { return 100 * setup + 10 * camera + repetition; }
  /// True for actions of two people (rose1.ntu.edu.sg); the second person has no number.
  bool is_mutual() const { return (action >= 50 && action <= 60) || action >= 106; }
  // The classes of the corpus's own list of actions.
  std::string_view class_id() const {
    if (is_mutual()) return "mutual";
    return (action >= 41 && action <= 49) || action >= 103 ? "medical" : "daily";
  }
};

/// The numbers of a file's name; absent for other files.
std::optional<ClipName> clip_of(std::string_view name) {
  ClipName out;
  std::string_view rest = stem_of(name);
  const bool fits =
      has_ending(name, ".skeleton") && take_digits(rest, "S", 3, out.setup) &&
      take_digits(rest, "C", 3, out.camera) && take_digits(rest, "P", 3, out.person) &&
      take_digits(rest, "R", 3, out.repetition) && take_digits(rest, "A", 3, out.action);
  return fits && rest.empty() ? std::optional(out) : std::nullopt;
}

/// The body seen longest; for actions of two people also the next one. `bodies` are sorted by this.
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

/// A clip is a take; clips without a skeleton are left out.
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
    // The bodies must be read to know which one to select.
    const auto bodies = KA_TRY(ntu_bodies([&opened] { return opened.next(); }, file.path));
    // Each clip is read to its end, so the user can stop between clips.
    if (!go_on(input.progress, "reading", out.takes.size(), input.sources.size())) {
      return Failure(interruption(file.path));
    }
    if (bodies.empty()) {
      out.left_out.push_back({stem, "without a skeleton"});
      continue;
    }
    out.takes.push_back({fmt::format("{:03}", clip->person), action, clip->run(),
                         clip_manifest(file.path, bodies, clip->is_mutual()), stem});
    // The corpus numbers its actions and gives no names in the files.
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
