// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/import/corpora.h"

#include "kinalign/core/nearest_name.h"

#include <algorithm>

namespace kinalign {

namespace {

/// The names of all kinds, with the file names by which they are recognised, for an error.
std::string words_of_kinds(const std::vector<CorpusKind>& kinds) {
  std::string text;
  for (const CorpusKind& kind : kinds) {
    text += (text.empty() ? "" : "; ") + std::string(kind.name) + " (" +
            std::string(kind.known_by) + ")";
  }
  return text;
}

}  // namespace

std::vector<CorpusKind> corpus_kinds() {
  std::vector<CorpusKind> kinds{ui_prmd_corpus(), ui_prmd_joints_corpus(),    cmu_corpus(),
                                keraal_corpus(),  kinect_multitrack_corpus(), ntu_corpus(),
                                bids_corpus()};
  for (CorpusKind& kind : motion_file_corpora()) kinds.push_back(std::move(kind));
  return kinds;
}

std::vector<std::string> corpus_kind_names() {
  std::vector<std::string> names;
  for (const CorpusKind& kind : corpus_kinds()) names.emplace_back(kind.name);
  return names;
}

Result<CorpusKind> find_corpus(FileSystem& files, const std::vector<SourceFile>& sources,
                               const std::string& wanted, const std::string& source) {
  std::vector<CorpusKind> own, general;
  for (const CorpusKind& kind : corpus_kinds()) {
    if (!wanted.empty() && kind.name == wanted) return kind;
    const auto is_own = [&](const SourceFile& file) { return kind.is_own(files, file); };
    if (!wanted.empty() || std::none_of(sources.begin(), sources.end(), is_own)) continue;
    // A BVH may also belong to a corpus about which more is known, so general kinds have the lowest
    // priority.
    (kind.general ? general : own).push_back(kind);
  }
  if (!wanted.empty()) return Failure(unknown_name(wanted, "a corpus", corpus_kind_names()));
  // If the files belong to several kinds, this is an error: the user must choose with --from.
  const std::vector<CorpusKind>& found = own.empty() ? general : own;
  if (found.size() == 1) return found.front();
  if (found.empty()) {
    return Failure(Error{source, 0, "files of a known corpus: " + words_of_kinds(corpus_kinds()),
                         sources.empty() ? "no files" : "others"});
  }
  return Failure(
      Error{source, 0, "files of one corpus, or --from with one of them", words_of_kinds(found)});
}

}  // namespace kinalign
