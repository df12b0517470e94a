// SPDX-License-Identifier: Apache-2.0
// Imports CMU's motion capture database in packed form: asf_00.npz has clips on each person's own
// skeleton, daz_05.npz clips on one body for all people. Each clip becomes a BVH.
#include "kinalign/dataset/import/cmu_clips.h"
#include "kinalign/dataset/import/corpora.h"
#include "kinalign/dataset/import/file_names.h"
#include "kinalign/dataset/import/ids.h"
#include "kinalign/dataset/import/new_folder.h"
#include "kinalign/formats/bvh/bvh.h"

#include <map>
#include <set>

namespace kinalign {

namespace {

/// True for a pack, which is recognised by its name. Other NPZ files are not read.
bool is_clip_pack(FileSystem&, const SourceFile& file) {
  const std::string_view stem = stem_of(file.name);
  return has_ending(file.name, ".npz") && (stem.starts_with("asf_") || stem.starts_with("daz_"));
}

/// CMU's number of the trial: 29 for "13_29"; 0 if the take has another name.
std::uint32_t trial_of(const PackedClip& clip) {
  const std::string lead = clip.person + "_";
  // Clips of other collections have other names; they get the next free run.
  if (!clip.take.starts_with(lead)) return 0;
  return whole_number(std::string_view(clip.take).substr(lead.size())).value_or(0);
}

/// The names of the clips' files: "13__13_29.bvh". Characters that a file name can't have are
/// replaced.
std::vector<std::string> file_names_of(const std::vector<PackedClip>& clips) {
  std::vector<std::string> out;
  std::set<std::string> given;
  for (const PackedClip& clip : clips) {
    const auto safe = [](std::string text) {
      for (char& c : text) {
        // label_of() keeps letters and digits. Of all other characters only the dash is kept here.
        if (label_of({&c, 1}) == "x" && c != 'x' && c != '-') c = '_';
      }
      return text;
    };
    const std::string name = safe(clip.person) + "__" + safe(clip.take);
    std::string own = name + ".bvh";
    // If two clips have the same name, their files get different names.
    for (int number = 2; !given.insert(own).second; ++number) {
      own = name + "__" + std::to_string(number) + ".bvh";
    }
    out.push_back(own);
  }
  return out;
}

/// Writes each clip as a BVH.
Result<void> write_clips(const PackedClips& packed, const std::vector<std::string>& names,
                         const PutFile& put, const ImportInput& input, const std::string& file) {
  for (std::size_t k = 0; k < names.size(); ++k) {
    OutputFile out = KA_TRY(put(names[k]));
    // The clip's own rate becomes the frame time of the BVH.
    const BvhFile bvh = bvh_from_clip(packed.clip(packed.clips()[k]), packed.frame_seconds());
    KA_TRY(write_bvh(bvh, [&out](std::string_view bytes) { return out.write(bytes); }));
    KA_TRY(out.commit());
    if (!go_on(input.progress, "unpacking", k + 1, names.size())) {
      return Failure(interruption(file));
    }
  }
  return {};
}

/// The take of one clip, with one stream. The action is CMU's short label, not its description.
CorpusTake take_of(const PackedClip& clip, const std::string& path) {
  CorpusTake out{clip.person, clip.label, trial_of(clip), {}, clip.take};
  out.manifest.streams.push_back(stream_of("mocap", path));
  return out;
}

/// Leaves out clips that another pack has on the person's own skeleton. Otherwise both copies could
/// be in different parts of a split.
void leave_out_doubles(std::map<std::string, CorpusTake>& takes,
                       const std::set<std::string>& doubles, Corpus& corpus) {
  for (auto& [key, take] : takes) {
    if (doubles.contains(key)) {
      corpus.left_out.push_back({key, "also available on the person's own skeleton"});
    } else {
      corpus.takes.push_back(std::move(take));
    }
  }
}

/// Reads each pack once, writes its clips as BVHs, and lists a take for each clip.
Result<Corpus> list_cmu(const ImportInput& input) {
  Corpus out{.name = "CMU Graphics Lab Motion Capture Database",
             .licence = "free for all uses; the data itself may not be resold",
             .citation =
                 "The data used in this project was obtained from mocap.cs.cmu.edu. The "
                 "database was created with funding from NSF EIA-0196217.",
             .classes = {{"cmu", "CMU's database, sorted by its descriptions"}},
             .class_id = "cmu"};
  std::map<std::string, CorpusTake> takes;  // by names as in clip_same: "asf_06:06_01"
  // The names of clips that another pack also has.
  std::set<std::string> doubles;
  for (const SourceFile& file : input.sources) {
    if (!is_clip_pack(input.files, file)) continue;
    const auto packed = KA_TRY(PackedClips::read(KA_TRY(archive_bytes(input.files, file.path))));
    const auto names = file_names_of(packed.clips());
    // The BVHs are written once; a later import uses the same folder.
    const std::string folder =
        KA_TRY(unpacked_folder(input.files, input.raw_folder, file.path, [&](const PutFile& put) {
          return write_clips(packed, names, put, input, file.path);
        }));
    for (std::size_t k = 0; k < names.size(); ++k) {
      const PackedClip& clip = packed.clips()[k];
      std::string key = std::string(stem_of(file.name)) + ":" + clip.take;
      // A second clip with the same name is another clip, not a copy of the first.
      if (takes.contains(key)) key += " of clip " + std::to_string(k);
      takes.emplace(std::move(key), take_of(clip, folder + "/" + names[k]));
      if (!clip.same.empty()) doubles.insert(clip.same);
    }
  }
  // Copies in other packs are known only after all packs were read.
  leave_out_doubles(takes, doubles, out);
  return out;
}

}  // namespace

CorpusKind cmu_corpus() { return {"cmu", "asf_00.npz, daz_05.npz", false, is_clip_pack, list_cmu}; }

}  // namespace kinalign
