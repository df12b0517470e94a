// SPDX-License-Identifier: Apache-2.0
// Imports any folder of BVH, C3D, TRC or MVNX files: each file becomes a take with one stream. The
// names of folders and files state subject and action (file_names.h).
#include "kinalign/dataset/import/corpora.h"
#include "kinalign/dataset/import/file_names.h"

#include <algorithm>
#include <filesystem>

namespace kinalign {

namespace {

// The endings of the four kinds of file. The functions below are instantiated for each of them.
constexpr std::string_view bvh = ".bvh", c3d = ".c3d", mvnx = ".mvnx", packed_mvnx = ".mvnx.gz",
                           trc = ".trc";

template <const std::string_view& ending>
bool is_one(FileSystem&, const SourceFile& file) {
  // MVNX files are often packed; they are read without unpacking them first.
  if (ending == mvnx && has_ending(file.name, packed_mvnx)) return true;
  return has_ending(file.name, ending);
}

/// The name without the ending of packing: "walk.mvnx.gz" gives "walk.mvnx".
std::string without_packing(const std::string& name) {
  return has_ending(name, packed_mvnx) ? name.substr(0, name.size() - 3) : name;
}

/// The folder that the user gave. Its name becomes the name of the collection.
std::string folder_name(const std::vector<SourceFile>& sources) {
  const std::filesystem::path path(sources.front().path);
  std::error_code fault;
  std::filesystem::path up = std::filesystem::weakly_canonical(path, fault).parent_path();
  // A source's name has one slash for each folder between the given folder and the file.
  const std::string& name = sources.front().name;
  for (auto slash = std::count(name.begin(), name.end(), '/'); slash > 0; --slash) {
    up = up.parent_path();
  }
  return up.filename().string();
}

/// Lists each file as a take. Files without a subject are left out.
template <const std::string_view& ending>
Result<Corpus> list_motion_files(const ImportInput& input) {
  constexpr const char* unnamed = "motion";
  Corpus out{.name = folder_name(input.sources),
             .classes = {{"motion", "not sorted into classes"}},
             .class_id = "motion"};
  std::vector<SourceFile> files;
  std::vector<std::string> names;
  for (const SourceFile& file : input.sources) {
    if (!is_one<ending>(input.files, file)) continue;
    files.push_back(file);
    names.push_back(without_packing(file.name));
  }
  // All names are read together: folders mean people only if this fits all files.
  const auto says = read_file_names(names);
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string subject = says[i].subject.empty() ? input.subject : says[i].subject;
    // If a name is only a number, the action has a default name.
    const std::string named = says[i].action.empty() ? unnamed : says[i].action;
    if (subject.empty()) {
      out.left_out.push_back({files[i].name, "no folder or name states the person (--subject ID)"});
      continue;
    }
    CorpusTake take{
        subject, input.action.empty() ? named : input.action, says[i].run, {}, files[i].name};
    take.manifest.streams.push_back(stream_of("mocap", files[i].path));
    out.takes.push_back(std::move(take));
  }
  return out;
}

template <const std::string_view& ending>
CorpusKind kind(std::string_view name, std::string_view known_by) {
  // MVNX states its unit and axes, so the user can't give others.
  return {name, known_by, true, is_one<ending>, list_motion_files<ending>, ending != mvnx};
}

}  // namespace

std::vector<CorpusKind> motion_file_corpora() {
  return {kind<bvh>("bvh", "*.bvh"), kind<c3d>("c3d", "*.c3d"),
          kind<mvnx>("mvnx", "*.mvnx, *.mvnx.gz"), kind<trc>("trc", "*.trc")};
}

}  // namespace kinalign
