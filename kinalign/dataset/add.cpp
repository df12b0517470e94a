// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/add.h"

#include "kinalign/core/nearest_name.h"
#include "kinalign/dataset/scan.h"
#include "kinalign/documents/manifest_toml.h"
#include "kinalign/formats/take/guarded.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/recording/beside.h"
#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/sources/formats.h"
#include "kinalign/take/remembered_path.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>

namespace kinalign {

namespace {

namespace fs = std::filesystem;

template <class One>
std::vector<std::string> ids_of(const std::vector<One>& all) {
  std::vector<std::string> ids;
  for (const One& one : all) ids.push_back(one.id);
  return ids;
}

/// Fails where dataset.toml does not know the subject or the action.
Result<void> check_known(const Catalogue& catalogue, const AddRequest& request,
                         const std::string& subject, const std::string& action) {
  const auto fault = [&](const std::string& id, const std::string& what, const std::string& table,
                         const std::vector<std::string>& known) -> Failure {
    const std::string flag = what == "a subject" ? "--subject" : "--action";
    if (id.empty()) {
      return Failure(
          Error{request.path, 0, what + ", by " + flag + " where the file names none", "none"});
    }
    Error error = unknown_name(id, what + " of dataset.toml ([" + table + "." + id + "])", known);
    error.file = request.path;
    return Failure(std::move(error));
  };
  if (find_subject(catalogue, subject) == nullptr) {
    return fault(subject, "a subject", "subject", ids_of(catalogue.subjects));
  }
  if (find_action(catalogue, action) == nullptr) {
    return fault(action, "an action", "action", ids_of(catalogue.actions));
  }
  return {};
}

Result<void> make_folders(const std::string& path) {
  std::error_code fault;
  fs::create_directories(path, fault);
  if (!fault) return {};
  return Failure(Error{path, 0, "a folder that can be made", fault.message()});
}

/// Copies a file; nothing that stands at `to` is replaced.
Result<void> copy_file(FileSystem& files, const std::string& from, const std::string& to) {
  InputFile in = KA_TRY(InputFile::open(files, from));
  OutputFile out = KA_TRY(OutputFile::create(files, to, Overwrite::no));
  for (;;) {
    const std::string_view piece = KA_TRY(in.next());
    if (piece.empty()) return out.commit();
    KA_TRY(out.write(piece));
  }
}

/// Fails where anything stands at `path`.
Result<void> write_new(FileSystem& files, const std::string& path, const std::string& text) {
  OutputFile out = KA_TRY(OutputFile::create(files, path, Overwrite::no));
  KA_TRY(out.write(text));
  return out.commit();
}

/// A path without links, in one spelling.
std::string one_spelling(const std::string& path) {
  std::error_code fault;
  const fs::path whole = fs::weakly_canonical(path, fault);
  return fault ? path : whole.string();
}

/// A file's path in a manifest: relative to `base` where the file lies below the data set.
std::string as_named(const std::string& path, const std::string& folder, const std::string& base) {
  const std::string whole = one_spelling(path), root = one_spelling(folder) + "/";
  if (!whole.starts_with(root)) return whole;
  return fs::path(whole).lexically_relative(one_spelling(base)).string();
}

struct Adding {
  FileSystem& files;
  const std::string& folder;
  const Catalogue& catalogue;
  const AddRequest& request;
  const Progress& progress;

  Result<Added> recording() const;
  Result<Added> manifest() const;
  Result<Added> take() const;

 private:
  Result<Added> put(Manifest manifest, const std::string& base) const;
  Result<std::vector<TakeName>> known(const std::string& subject, const std::string& action) const;
  Result<void> copy_inputs(Manifest& manifest, const TakeName& name) const;
  Result<Manifest> placed(Manifest manifest, const std::string& base, const TakeName& name) const;
};

/// The takes of a subject and an action that are there.
Result<std::vector<TakeName>> Adding::known(const std::string& subject,
                                            const std::string& action) const {
  std::vector<TakeName> names;
  for (const auto& [name, there] : KA_TRY(scan_takes(folder, subject))) {
    if (name.action == action) names.push_back(name);
  }
  return names;
}

TakeName next_of(const std::vector<TakeName>& known, const std::string& subject,
                 const std::string& action) {
  TakeName name{subject, action, 1};
  for (const TakeName& one : known) name.run = std::max(name.run, one.run + 1);
  return name;
}

/// Copies the files that a manifest names below sourcedata/, further files of a recording too.
Result<void> Adding::copy_inputs(Manifest& manifest, const TakeName& name) const {
  const std::string to = folder + "/sourcedata/sub-" + name.subject + "/" + to_string(name);
  KA_TRY(make_folders(to));
  for (std::string* path : paths_in(manifest)) {
    for (const std::string& one : with_namesakes(files, {*path})) {
      const std::string copied = to + "/" + std::string(file_name(one));
      if (!fs::exists(copied)) KA_TRY(copy_file(files, one, copied));
    }
    *path = to + "/" + std::string(file_name(*path));
  }
  return {};
}

/// With the paths that it has at its place.
Result<Manifest> Adding::placed(Manifest manifest, const std::string& base,
                                const TakeName& name) const {
  for (std::string* path : paths_in(manifest)) *path = path_in(base, *path);
  if (request.copy) KA_TRY(copy_inputs(manifest, name));
  const std::string own = folder + "/sub-" + name.subject;
  for (std::string* path : paths_in(manifest)) *path = as_named(*path, folder, own);
  manifest.subject = name.subject;
  manifest.action = name.action;
  return manifest;
}

Result<Added> Adding::put(Manifest manifest, const std::string& base) const {
  const std::string subject = request.subject.empty() ? manifest.subject : request.subject;
  const std::string action = request.action.empty() ? manifest.action : request.action;
  KA_TRY(check_known(catalogue, request, subject, action));
  KA_TRY(make_folders(folder + "/sub-" + subject));
  for (;;) {  // until no other process takes the same run
    const std::vector<TakeName> names = KA_TRY(known(subject, action));
    const TakeName name = next_of(names, subject, action);
    const std::string text = manifest_toml(KA_TRY(placed(manifest, base, name)));
    for (const TakeName& one : names) {
      const auto old =
          read_whole(files, folder + "/" + path_of(one, TakeFile::manifest), longest_manifest);
      if (old && *old == text) return Added{one, true};
    }
    const std::string path = folder + "/" + path_of(name, TakeFile::manifest);
    const Result<void> written = write_new(files, path, text);
    if (!written && fs::exists(path)) continue;
    KA_TRY(written);
    return Added{name, false};
  }
}

Result<Added> Adding::recording() const {
  const auto source = KA_TRY(
      RecordingSource::open(files, request.path, RecordingSource::Devices::unheard, {}, progress));
  const RecordingSurvey survey = source->survey();
  Manifest manifest = KA_TRY(manifest_of(survey, std::string(file_name(request.path))));
  if (survey.facts) {
    manifest.subject = survey.facts->subject;
    manifest.action = survey.facts->action;
  }
  return put(std::move(manifest), std::string(kinalign::folder(request.path)));
}

Result<Added> Adding::manifest() const {
  const std::string text = KA_TRY(read_whole(files, request.path, longest_manifest));
  return put(KA_TRY(read_manifest(text, request.path)),
             std::string(kinalign::folder(request.path)));
}

Result<Added> Adding::take() const {
  const Error blame{request.path, 0, "a take that HDF5 can read", ""};
  const std::string said = KA_TRY(run_guarded(GuardLimits{}, blame, [&]() -> Result<std::string> {
    const TakeReader reader = KA_TRY(TakeReader::open(files, request.path));
    return reader.header().subject + "\n" + reader.header().action;
  }));
  const std::string subject = said.substr(0, said.find('\n'));
  const std::string action = said.substr(said.find('\n') + 1);
  const auto differs = [&](const std::string& wanted, const std::string& own) {
    return !wanted.empty() && wanted != own;
  };
  if (differs(request.subject, subject) || differs(request.action, action)) {
    return Failure(Error{request.path, 0,
                         "a take of subject " + shown(request.subject) + " and action " +
                             shown(request.action) + ", which a take says itself",
                         shown(subject) + " and " + shown(action)});
  }
  KA_TRY(check_known(catalogue, request, subject, action));
  KA_TRY(make_folders(folder + "/sub-" + subject));
  const TakeName name = next_of(KA_TRY(known(subject, action)), subject, action);
  KA_TRY(copy_file(files, request.path, folder + "/" + path_of(name, TakeFile::take)));
  return Added{name, false};
}

}  // namespace

Result<Added> add_take(FileSystem& files, const std::string& folder, const Catalogue& catalogue,
                       const AddRequest& request, const Progress& progress) {
  const Adding adding{files, folder, catalogue, request, progress};
  switch (KA_TRY(kind_of_file(files, request.path))) {
    case FileKind::recording:
      return adding.recording();
    case FileKind::manifest:
      return adding.manifest();
    case FileKind::take:
      return adding.take();
    default:
      return Failure(Error{request.path, 0,
                           "a recording, a recording.toml or a take (single files go into a "
                           "recording.toml)",
                           "another file"});
  }
}

}  // namespace kinalign
