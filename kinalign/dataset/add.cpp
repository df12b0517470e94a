// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/add.h"

#include "kinalign/core/nearest_name.h"
#include "kinalign/dataset/scan.h"
#include "kinalign/dataset/take_inputs.h"
#include "kinalign/documents/manifest_toml.h"
#include "kinalign/formats/take/guarded.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/recording/parts.h"
#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/sources/formats.h"
#include "kinalign/sources/input_facts.h"
#include "kinalign/take/remembered_path.h"

#include <filesystem>
#include <optional>
#include <system_error>

namespace kinalign {

namespace {

namespace fs = std::filesystem;

template <class One>
std::vector<std::string> ids_of(const std::vector<One>& all) {
  std::vector<std::string> ids;
  ids.reserve(all.size());
  for (const One& one : all) ids.push_back(one.id);
  return ids;
}

/// Fails if dataset.toml does not have the subject or the action.
Result<void> check_known(const Catalogue& catalogue, const AddRequest& request,
                         const std::string& subject, const std::string& action) {
  // The error names the flag if the id is missing, and similar ids if it is unknown.
  const auto fault = [&](const std::string& id, const std::string& what, const std::string& table,
                         const std::vector<std::string>& known) -> Failure {
    const std::string flag = what == "a subject" ? "--subject" : "--action";
    if (id.empty()) {
      return Failure(
          Error{request.path, 0, what + " (give " + flag + " if the file names none)", "nothing"});
    }
    Error error = unknown_name(id, what + " of dataset.toml ([" + table + "." + id + "])", known);
    error.file = request.path;
    return Failure(std::move(error));
  };
  // An id must be described before takes can have it.
  if (find_subject(catalogue, subject) == nullptr) {
    return fault(subject, "a subject", "subject", ids_of(catalogue.subjects));
  }
  if (find_action(catalogue, action) == nullptr) {
    return fault(action, "an action", "action", ids_of(catalogue.actions));
  }
  return {};
}

/// The absolute path without links, so that one file has one spelling.
std::string one_spelling(const std::string& path) {
  std::error_code fault;
  const fs::path whole = fs::weakly_canonical(path, fault);
  return fault ? path : whole.string();
}

/// True if the file or folder `path` is below `folder`, after all links are followed.
bool is_below(const std::string& path, const std::string& folder) {
  return one_spelling(path).starts_with(one_spelling(folder) + "/");
}

/// A file's path in a manifest: relative to `base` if the file lies below the data set's folder,
/// else absolute.
std::string as_named(const std::string& path, const std::string& folder, const std::string& base) {
  std::string whole = one_spelling(path);
  if (!is_below(path, folder)) return whole;
  return fs::path(whole).lexically_relative(one_spelling(base)).string();
}

/// A raw file, and the place of its copy.
struct RawCopy {
  std::string from, to;
};

/// Plans the copies of a manifest's files into a folder of the take, which ends in '/'.
class CopyPlan {
 public:
  CopyPlan(FileSystem& files, const std::string& folder, std::string to)
      : files_(files), folder_(folder), to_(std::move(to)) {}

  /// Returns the manifest with the paths of the copies. Files that are in the data set already stay
  /// there.
  Manifest plan(Manifest manifest) {
    for (StreamOptions& stream : manifest.streams) {
      // The reader must see the original paths while the stream's own paths are replaced one by
      // one.
      const StreamOptions given_stream = stream;
      for (std::size_t i = 0; i < stream.files.size(); ++i) {
        stream.files[i].path = place(given_stream, given_stream.files[i]);
      }
      if (stream.own_layout()) stream.layout = place_alone(stream.name, stream.layout);
      if (!stream.skeleton.empty()) stream.skeleton = place_alone(stream.name, stream.skeleton);
    }
    return manifest;
  }
  const std::vector<RawCopy>& copies() const { return copies_; }

 private:
  /// Plans the copy of one file. If its reader opens further files, the copy is in a folder with
  /// the same name, because readers find the further files by the folder's name.
  std::string place(const StreamOptions& stream, const StreamFile& file) {
    if (is_below(file.path, folder_)) return file.path;
    auto further = further_files_of(files_, stream, file);
    // A layout is not found through the file's folder, so it is copied separately.
    std::erase(further, stream.layout);
    if (further.empty()) {
      // The parts of a recording are found by their names, so all of them are copied.
      for (const std::string& one : with_siblings(files_, {file.path})) {
        place_alone(stream.name, one);
      }
      return place_alone(stream.name, file.path);
    }
    const fs::path base = fs::path(one_spelling(file.path)).parent_path();
    const fs::path own = fs::path(to_) / stream.name / base.filename();
    for (const std::string& one : further) {
      // All these files keep their paths relative to each other.
      const fs::path step = fs::path(one_spelling(one)).lexically_relative(base);
      copies_.push_back({one, (own / step).lexically_normal().string()});
    }
    copies_.push_back({file.path, (own / file_name(file.path)).string()});
    return copies_.back().to;
  }

  /// Plans the copy of a file without further files. If two streams have files of the same name,
  /// the second one is copied into a folder with the stream's name.
  std::string place_alone(const std::string& stream, const std::string& path) {
    if (is_below(path, folder_)) return path;
    std::string to = to_ + std::string(file_name(path));
    for (const RawCopy& one : copies_) {
      // If two streams read the same file, it is copied once.
      if (one.from == path) return one.to;
      if (one.to == to) to = to_ + stream + "/" + std::string(file_name(path));
    }
    copies_.push_back({path, to});
    return to;
  }

  FileSystem& files_;
  const std::string& folder_;
  std::string to_;
  std::vector<RawCopy> copies_;
};

/// A manifest's text without the take's own name. Two takes from the same raw files then have the
/// same text, although their runs differ.
std::string without_own_name(std::string text, const TakeName& name) {
  // The take's own folder occurs only in the paths of copied files.
  const std::string own = raw_folder(name);
  for (auto at = text.find(own); at != std::string::npos; at = text.find(own, at)) {
    text.erase(at, own.size());
  }
  return text;
}

/// The manifest's text with paths relative to the folder of its subject.
std::string placed_text(Manifest manifest, const std::string& folder, const TakeName& name) {
  // Paths in a manifest are relative to the manifest's own folder.
  const std::string own = folder + "/sub-" + name.subject;
  for (std::string* path : paths_in(manifest)) *path = as_named(*path, folder, own);
  manifest.subject = name.subject;
  manifest.action = name.action;
  return manifest_toml(manifest);
}

/// Sizes are compared first, so most different files need no reading.
Result<bool> same_bytes(FileSystem& files, const RawCopy& copy) {
  std::error_code fault;
  if (fs::file_size(copy.from, fault) != fs::file_size(copy.to, fault) || fault) return false;
  const InputFacts from = KA_TRY(facts_of(files, copy.from, "hashing", {}));
  return from.sha256 == KA_TRY(facts_of(files, copy.to, "hashing", {})).sha256;
}

/// Makes the copies. A copy that exists already is kept, so that a stopped job can continue.
/// Returns false if a file with other bytes is in the place of a copy: it belongs to a removed
/// take, or to one that another process adds.
Result<bool> make_copies(FileSystem& files, const std::vector<RawCopy>& copies) {
  for (const RawCopy& copy : copies) {
    KA_TRY(make_folders(fs::path(copy.to).parent_path().string()));
    const Result<void> copied =
        is_there(copy.to) ? Result<void>{} : copy_file(files, copy.from, copy.to);
    // Another process may have made the same copy meanwhile, so the bytes are compared.
    if (!copied && !is_there(copy.to)) return Failure(copied.error());
    if (!KA_TRY(same_bytes(files, copy))) return false;
  }
  return true;
}

/// The wanted run if it is free, else the run after all existing ones.
std::uint32_t free_run(const std::set<std::uint32_t>& runs, std::uint32_t wanted) {
  if (wanted > 0 && !runs.contains(wanted)) return wanted;
  return runs.empty() ? 1 : *runs.rbegin() + 1;
}

}  // namespace

/// Reads the runs and manifests of a subject and an action.
Result<TakeAdder::Known> TakeAdder::read_known(const std::string& subject,
                                               const std::string& action) const {
  // For a new person this creates the folder.
  KA_TRY(make_folders(folder_ + "/sub-" + subject));
  Known out;
  for (const auto& [name, there] : KA_TRY(scan_takes(folder_, subject))) {
    if (name.action != action) continue;
    out.runs.insert(name.run);
    const auto text =
        read_whole(files_, path_of(folder_, name, TakeFile::manifest), longest_manifest);
    // A take without a readable manifest can't be compared, but its run counts as taken.
    if (text) out.by_text.emplace(without_own_name(*text, name), name);
  }
  return out;
}

/// The takes of a person and action, read when they are first needed. The pointer is valid until
/// `known_` is changed.
Result<TakeAdder::Known*> TakeAdder::known(const std::string& subject, const std::string& action) {
  const auto key = std::pair(subject, action);
  auto at = known_.find(key);
  if (at == known_.end()) {
    at = known_.emplace(key, KA_TRY(read_known(subject, action))).first;
  }
  return &at->second;
}

/// The take that was added before from the same manifest. If the raw files are to be copied, the
/// bytes of the copies must be the same, too.
Result<std::optional<TakeName>> TakeAdder::find_same(const Known& known, const Manifest& manifest,
                                                     const std::string& text, bool copy) const {
  const auto [begin, end] = known.by_text.equal_range(text);
  // Several takes may have the same manifest text and differ in the copied raw files.
  for (auto one = begin; one != end; ++one) {
    // If nothing is copied, equal texts name the same raw files, so the takes are the same.
    bool same = true;
    if (copy) {
      // The raw files are compared with the copies of the existing take.
      CopyPlan plan(files_, folder_, folder_ + "/" + raw_folder(one->second));
      plan.plan(manifest);
      for (const RawCopy& file : plan.copies()) same = same && KA_TRY(same_bytes(files_, file));
    }
    if (same) return one->second;
  }
  return std::nullopt;
}

Result<Added> TakeAdder::add(const Manifest& given, const std::string& base,
                             const AddRequest& request) {
  TakeName name{request.subject.empty() ? given.subject : request.subject,
                request.action.empty() ? given.action : request.action, 1};
  KA_TRY(check_known(catalogue_, request, name.subject, name.action));
  Manifest manifest = given;
  for (std::string* path : paths_in(manifest)) *path = path_in(base, *path);
  for (;;) {  // repeat until no other process takes the same run
    Known& there = *KA_TRY(known(name.subject, name.action));
    name.run = free_run(there.runs, request.run);
    // The copies' paths contain the run, so the copies are planned again for each run that is
    // tried.
    CopyPlan plan(files_, folder_, folder_ + "/" + raw_folder(name));
    const std::string text =
        placed_text(request.copy ? plan.plan(manifest) : manifest, folder_, name);
    const std::string nameless = without_own_name(text, name);
    // A second import of the same files adds nothing.
    if (const auto same = KA_TRY(find_same(there, manifest, nameless, request.copy))) {
      return Added{*same, true};
    }
    if (!KA_TRY(make_copies(files_, plan.copies()))) {
      there.runs.insert(name.run);  // its raw files belong to another take
      continue;
    }
    const std::string path = path_of(folder_, name, TakeFile::manifest);
    // Creating the manifest reserves the run: only one process can create it.
    const Result<void> written = write_whole(files_, path, text, Overwrite::no);
    if (written) {
      there.runs.insert(name.run);
      there.by_text.emplace(nameless, name);
      return Added{name, false};
    }
    // Only if the file has appeared meanwhile, the next run is tried.
    if (!is_there(path) || there.runs.contains(name.run)) return Failure(written.error());
    // Another process took the run, so the takes are read again.
    known_.erase({name.subject, name.action});
  }
}

/// Subject and action come from the recording, if it states them.
Result<Added> TakeAdder::add_recording(const AddRequest& request, const Progress& progress) {
  // The devices can be listed without learning their clocks.
  const auto source = KA_TRY(RecordingSource::open(
      files_, request.path, RecordingSource::Devices::surveyed, {}, progress));
  const RecordingSurvey survey = source->survey();
  Manifest manifest = KA_TRY(manifest_of(survey, std::string(file_name(request.path))));
  if (survey.facts) {
    manifest.subject = survey.facts->subject;
    manifest.action = survey.facts->action;
  }
  return add(manifest, std::string(kinalign::folder(request.path)), request);
}

/// A take states its subject and action in its own bytes, so the request can't change them.
Result<Added> TakeAdder::add_take(const AddRequest& request) {
  // HDF5 can crash on a hostile file, so a child process opens the take.
  const Error blame{request.path, 0, "a take that HDF5 can read", ""};
  const std::string ids = KA_TRY(run_guarded(GuardLimits{}, blame, [&]() -> Result<std::string> {
    const TakeReader reader = KA_TRY(TakeReader::open(files_, request.path));
    // The child process returns one text; a line end separates the two ids.
    return reader.header().subject + "\n" + reader.header().action;
  }));
  const std::string subject = ids.substr(0, ids.find('\n'));
  const std::string action = ids.substr(ids.find('\n') + 1);
  // An empty id in the request agrees with every take.
  const auto differs = [&](const std::string& wanted, const std::string& own) {
    return !wanted.empty() && wanted != own;
  };
  if (differs(request.subject, subject) || differs(request.action, action)) {
    return Failure(Error{request.path, 0,
                         "a take of subject " + shown(request.subject) + " and action " +
                             shown(request.action) + " (a take states both)",
                         shown(subject) + " and " + shown(action)});
  }
  KA_TRY(check_known(catalogue_, request, subject, action));
  Known& there = *KA_TRY(known(subject, action));
  for (const std::uint32_t run : there.runs) {
    const TakeName one{subject, action, run};
    const RawCopy copy{request.path, path_of(folder_, one, TakeFile::take)};
    // The same take was added before, with this run.
    if (is_there(copy.to) && KA_TRY(same_bytes(files_, copy))) return Added{one, true};
  }
  const TakeName name{subject, action, free_run(there.runs, 0)};
  // The take is copied unchanged, so its hash stays the same.
  KA_TRY(copy_file(files_, request.path, path_of(folder_, name, TakeFile::take)));
  there.runs.insert(name.run);
  return Added{name, false};
}

Result<Added> TakeAdder::add(const AddRequest& request, const Progress& progress) {
  switch (KA_TRY(kind_of_file(files_, request.path))) {
    case FileKind::recording:
      return add_recording(request, progress);
    case FileKind::manifest: {
      const std::string text = KA_TRY(read_whole(files_, request.path, longest_manifest));
      return add(KA_TRY(read_manifest(text, request.path)),
                 std::string(kinalign::folder(request.path)), request);
    }
    case FileKind::take:
      return add_take(request);
    default:
      return Failure(Error{request.path, 0,
                           "a recording, a recording.toml or a take (single files go into a "
                           "recording.toml)",
                           "a file of another kind"});
  }
}

}  // namespace kinalign
