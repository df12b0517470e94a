// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/import/import.h"

#include "kinalign/dataset/import/catalogue_growth.h"
#include "kinalign/dataset/import/corpora.h"
#include "kinalign/dataset/import/ids.h"
#include "kinalign/dataset/import/new_folder.h"
#include "kinalign/dataset/scan.h"
#include "kinalign/syntax/toml.h"

#include <algorithm>
#include <optional>
#include <set>

namespace kinalign {

namespace {

constexpr std::size_t longest_catalogue = std::size_t{64} << 20;

std::string catalogue_path(const std::string& folder) {
  return folder + "/" + std::string(catalogue_file);
}

/// The text of dataset.toml; absent if the folder is no data set.
Result<std::optional<std::string>> read_catalogue_text(FileSystem& files,
                                                       const std::string& folder) {
  const std::string path = catalogue_path(folder);
  if (!is_there(path)) return std::nullopt;
  return KA_TRY(read_whole(files, path, longest_catalogue));
}

/// The ids of known actions with their names. Ids uses them to recognise words of an earlier
/// import.
std::vector<std::pair<std::string, std::string>> named(const std::vector<Action>& actions) {
  std::vector<std::pair<std::string, std::string>> out;
  out.reserve(actions.size());
  for (const Action& one : actions) out.emplace_back(one.id, one.name);
  return out;
}

/// The ids for the words of the corpus, and the entries that dataset.toml needs for them.
struct Named {
  Ids subjects, actions;
  CatalogueNeeds needs;
};

/// Replaces the words of the takes by ids, and collects the entries for dataset.toml.
Named name_takes(Corpus& corpus, const Catalogue& has) {
  // Names of people are not stored. The same word therefore means the same person in every import.
  Named out{Ids({}), Ids(named(has.actions)), {}};
  std::set<std::string> subjects, actions;
  for (CorpusTake& take : corpus.takes) {
    const std::string subject = out.subjects.of(take.subject), word = take.action;
    if (subjects.insert(subject).second) out.needs.subjects.push_back(subject);
    take.subject = subject;
    take.action = out.actions.of(word);
    // Each action is described once, from the first take that has it.
    if (!actions.insert(take.action).second) continue;
    const Action* const known = find_id(corpus.actions, word);
    out.needs.actions.push_back(
        {take.action, known ? known->class_id : corpus.class_id, known ? known->name : word});
  }
  out.needs.classes = corpus.classes;
  // The entries are sorted, so that dataset.toml does not depend on the order of files.
  std::sort(out.needs.subjects.begin(), out.needs.subjects.end());
  std::sort(out.needs.actions.begin(), out.needs.actions.end(),
            [](const Action& a, const Action& b) { return a.id < b.id; });
  return out;
}

/// Writes dataset.toml. If the folder is new, it becomes a data set.
Result<void> write_catalogue(FileSystem& files, const std::string& folder,
                             const std::string& text) {
  KA_TRY(make_folders(folder));
  return write_whole(files, catalogue_path(folder), text, Overwrite::yes);
}

/// Fails if the user states a unit or an axis, but the files state their own: it would be ignored.
Result<void> check_units(const CorpusKind& kind, const ImportRequest& request) {
  if (kind.unit_is_open || (request.metres_per_unit == 0.0 && request.up.empty())) return {};
  const char* flag = request.metres_per_unit == 0.0 ? "--up" : "--metres-per-unit";
  return Failure(Error{flag, 0, "files of bvh, c3d or trc", std::string(kind.name)});
}

/// All streams of the corpus have the unit and the axis that the user states.
void put_units(const ImportRequest& request, Corpus& corpus) {
  for (CorpusTake& take : corpus.takes) {
    for (StreamOptions& stream : take.manifest.streams) {
      stream.metres_per_unit = request.metres_per_unit;
      stream.up = request.up;
    }
  }
}

/// Finds the files, recognises the corpus and lists its takes. Archives and packs are unpacked
/// first. If no take is found, unpacked files are removed.
Result<Corpus> list_corpus(FileSystem& files, const std::string& folder,
                           const ImportRequest& request, const Progress& progress,
                           std::string& kind_name) {
  // Unpacked files become raw files of the data set.
  const std::string raw_folder = folder + "/sourcedata";
  std::optional<UnfinishedFolder> unfinished;  // removes the unpacked files if the import fails
  if (!is_there(raw_folder)) unfinished.emplace(raw_folder);
  const auto sources = KA_TRY(list_sources(files, request.sources, raw_folder, progress));
  const CorpusKind kind =
      KA_TRY(find_corpus(files, sources, request.from, request.sources.front()));
  kind_name = kind.name;
  KA_TRY(check_units(kind, request));
  Corpus corpus = KA_TRY(kind.list(
      {files, sources, raw_folder, request.subject, request.action, progress, request.jobs}));
  if (kind.unit_is_open) put_units(request, corpus);
  if (!corpus.takes.empty()) {
    // The takes need the unpacked files, so these are kept.
    if (unfinished) unfinished->keep();
    return corpus;
  }
  // The first part that was left out shows why there is no take.
  const std::string why = corpus.left_out.empty()
                              ? "none"
                              : corpus.left_out.front().what + ": " + corpus.left_out.front().why;
  return Failure(Error{request.sources.front(), 0,
                       "takes of " + kind_name + " (" + std::string(kind.known_by) + ")", why});
}

/// The text of dataset.toml. If it states no licence or citation, those of the corpus are added.
std::string with_terms(std::string text, const Corpus& corpus) {
  for (const auto& [key, value] :
       {std::pair("licence", &corpus.licence), {"citation", &corpus.citation}}) {
    // Only an empty text is replaced, so the user's own licence and citation stay.
    const std::string empty = std::string("\n") + key + " = \"\"";
    if (const auto at = text.find(empty); at != std::string::npos) {
      text.replace(at, empty.size(), std::string("\n") + key + " = " + toml_string(*value));
    }
  }
  return text;
}

/// The data set's catalogue with all entries that the takes need. It is written if entries were
/// added. A catalogue without people also gets the corpus's licence and citation.
Result<Catalogue> grow_catalogue(FileSystem& files, const std::string& folder,
                                 const std::optional<std::string>& text, const Corpus& corpus,
                                 const CatalogueNeeds& needs) {
  const std::string path = catalogue_path(folder);
  // A new data set gets the name, licence and citation of the corpus.
  std::string before = text.value_or(catalogue_head(corpus.name, corpus.licence, corpus.citation));
  // If the data set already has people, it has several sources, and the user must state the terms.
  if (KA_TRY(read_catalogue(before, path)).subjects.empty()) {
    before = with_terms(std::move(before), corpus);
  }
  const std::string grown = KA_TRY(grown_catalogue(before, path, needs));
  if (!text || grown != *text) KA_TRY(write_catalogue(files, folder, grown));
  return read_catalogue(grown, path);
}

/// Adds the takes; returns the number of those that existed before.
Result<std::uint64_t> add_takes(const Corpus& corpus, const ImportRequest& request,
                                TakeAdder& adder, const Progress& progress,
                                const ImportStep& step) {
  std::uint64_t done = 0, were_there = 0;
  for (const CorpusTake& take : corpus.takes) {
    // If a take exists already, its manifest is recognised.
    const AddRequest add{take.from, take.subject, take.action, request.copy, take.run};
    if (KA_TRY(adder.add(take.manifest, "", add)).was_there) ++were_there;
    step(++done, corpus.takes.size());
    if (!go_on(progress, "adding", done, corpus.takes.size())) return Failure(interruption());
  }
  return were_there;
}

}  // namespace

Result<Imported> import_corpus(FileSystem& files, const std::string& folder,
                               const ImportRequest& request, const Progress& progress,
                               const ImportStep& step) {
  const auto text = KA_TRY(read_catalogue_text(files, folder));
  Catalogue catalogue = text ? KA_TRY(read_catalogue(*text, catalogue_path(folder))) : Catalogue{};
  Imported out;
  out.is_new = !text;
  Corpus corpus = KA_TRY(list_corpus(files, folder, request, progress, out.kind));
  const Named names = name_takes(corpus, catalogue);
  // The catalogue must be complete before takes are added, because TakeAdder refuses unknown ids.
  catalogue = KA_TRY(grow_catalogue(files, folder, text, corpus, names.needs));
  TakeAdder adder(files, folder, catalogue);
  out.were_there = KA_TRY(add_takes(corpus, request, adder, progress, step));
  out.takes = corpus.takes.size();
  out.subjects = names.needs.subjects.size();
  out.actions = names.needs.actions.size();
  out.left_out = std::move(corpus.left_out);
  out.subject_ids = names.subjects.changed();
  out.action_ids = names.actions.changed();
  return out;
}

}  // namespace kinalign
