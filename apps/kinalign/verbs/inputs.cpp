// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/verbs/inputs.h"

#include "apps/cli/console.h"
#include "apps/cli/field_text.h"
#include "apps/kinalign/text/describe_file.h"

#include "kinalign/align/unused_options.h"
#include "kinalign/core/file_version.h"
#include "kinalign/core/files.h"
#include "kinalign/documents/manifest_toml.h"
#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/sources/open_recording.h"
#include "kinalign/take/remembered_path.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

namespace kinalign {

Result<std::pair<std::string, std::string>> split_pair(const std::string& text,
                                                       std::string_view expected) {
  const auto equals = text.find('=');
  // An empty name or value is a typing error for every flag of this form.
  if (equals == 0 || equals == std::string::npos || equals + 1 == text.size()) {
    return Failure(Error{"", 0, std::string(expected), "'" + shown(text) + "'"});
  }
  return std::pair{text.substr(0, equals), text.substr(equals + 1)};
}

Result<Manifest> load_manifest(FileSystem& files, const std::string& path,
                               const AlignOptions& unsaid) {
  // People write manifests by hand, so a manifest is short. The limit refuses a wrong file before
  // it fills the memory.
  constexpr std::size_t longest = std::size_t{1} << 20;
  const std::string text = KA_TRY(read_whole(files, path, longest));
  return read_manifest(text, path, unsaid);
}

Result<Manifest> recorded_manifest(const RecordingSurvey& survey, const std::string& path) {
  // An empty recording gets its own error, which names the cause.
  if (survey.messages == 0) {
    return Failure(Error{path, 0, "a recording in which a message can be read", "none"});
  }
  return manifest_of(survey, std::string(file_name(path))).map_error([&path](Error error) {
    error.file = path;
    return error;
  });
}

/// The flags of a single stream. Options of alignment are left out, because verbs that read a
/// single stream do not align it. `select` is a flag of the form COLUMN=VALUE.
Fields StreamFlags::fields() {
  constexpr std::array<std::string_view, 7> of_alignment{
      "clock", "offset_ms", "drift_ppm", "interval_ms", "root_node", "mounting", "select"};
  Fields out = describe(options);
  // describe() lists the options for manifests and for flags, so each new option becomes a flag.
  std::erase_if(out, [&](const Field& field) {
    return std::find(of_alignment.begin(), of_alignment.end(), field.name) != of_alignment.end();
  });
  out.push_back({"select", "rows of a table to use; may be repeated", &select});
  return out;
}

Result<void> StreamFlags::check_use(const std::string& path, const RecordedStream* stream,
                                    Call& call) const {
  for (const auto& [name, source] : call.sources) {
    const auto is = [&name = name](std::string_view other) { return name == other; };
    if (source != Source::flag) continue;
    // A manifest, a take or a recording states how its streams are read, so all flags that describe
    // a stream are refused.
    if (stream == nullptr) {
      StreamFlags mine;
      const Fields own = mine.fields();
      if (std::none_of(own.begin(), own.end(), [&](const Field& f) { return is(f.name); }))
        continue;
      return call.console.refuse(
          {flag_of(name), 0, "a stream's own file", shown(path) + ", which already states this"});
    }
    // The reader of a stream ignores some options, depending on the kind of stream. A flag that
    // would be ignored is wrong use.
    const auto useless = useless_options(*stream);
    if (std::none_of(useless.begin(), useless.end(), is)) continue;
    return call.console.refuse({flag_of(name), 0, "a file that can use this flag",
                                shown(path) + ": " + contents_line(*stream)});
  }
  return {};
}

Result<StreamOptions> StreamFlags::stream(const std::vector<std::string>& paths) const {
  StreamOptions out = options;
  // The name appears in messages and in the names of an NPZ's arrays.
  if (out.name.empty()) out.name = "stream";
  for (const std::string& path : paths) out.files.push_back({path, ""});
  for (const std::string& one : select) {
    const auto [column, value] =
        KA_TRY(split_pair(one, "COLUMN=VALUE").map_error(in_file("--select")));
    out.select[column] = value;
  }
  return out;
}

/// Opens the recording that a manifest describes, or the file of a single stream as a recording
/// with one stream.
Result<Input> open_input(FileSystem& files, const std::string& path, const StreamFlags& flags,
                         const Progress& progress) {
  Input input;
  if (path.ends_with(".toml")) {
    // Paths in a manifest are relative to the manifest's folder and not to the current folder.
    input.manifest = KA_TRY(load_manifest(files, path));
    input.recording =
        KA_TRY(open_recording(files, *input.manifest, std::string(folder(path)), {progress}));
    return input;
  }
  const StreamOptions options = KA_TRY(flags.stream({path}));
  input.recording = KA_TRY(open_streams(files, {options}, {progress}));
  return input;
}

int code_of(const Findings& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& f) { return f.severity != Severity::note; })
             ? 1
             : 0;
}

Result<void> check_take_name(const std::string& out) {
  // A take is always an HDF5 file. With one of these three endings other programs would try to open
  // it and fail.
  for (const std::string_view ending : {".npz", ".csv", ".bvh"}) {
    if (!out.ends_with(ending)) continue;
    return Failure(Error{
        "-o", 0,
        "a name for an HDF5 file, such as take.h5 (kinalign convert makes .npz and .bvh of a take)",
        shown(file_name(out))});
  }
  return {};
}

std::string name_advice(const Error& error) {
  const bool name = error.kind == ErrorKind::no_such_joint || error.kind == ErrorKind::no_such_node;
  return name ? "kinalign info FILE -v lists the names of joints and nodes" : "";
}

Result<std::optional<std::uint64_t>> first_difference(FileSystem& files, const std::string& a,
                                                      const std::string& b) {
  InputFile one = KA_TRY(InputFile::open(files, a)), other = KA_TRY(InputFile::open(files, b));
  // Both files are read in pieces, which may end at different places. Each turn compares as many
  // bytes as both pieces still have.
  std::string_view p, q;  // the bytes of each piece that are not compared yet
  for (std::uint64_t at = 0;;) {
    if (p.empty()) p = KA_TRY(one.next());
    if (q.empty()) q = KA_TRY(other.next());
    if (p.empty() && q.empty()) return std::optional<std::uint64_t>{};
    const std::size_t both = std::min(p.size(), q.size());
    const auto differ = std::mismatch(p.begin(), p.begin() + both, q.begin());
    const auto same = static_cast<std::size_t>(differ.first - p.begin());
    at += same;
    // If only one file has ended, `both` is 0, and the shorter file is the beginning of the longer
    // one.
    if (same < both || both == 0) return std::optional(at);
    p.remove_prefix(both);
    q.remove_prefix(both);
  }
}

Result<void> keep_inputs(const std::string& out, const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    // same_file() follows links, so it also finds the same file under another path.
    if (same_file(out, input)) {
      return Failure(Error{out, 0, "a name other than those of the input files",
                           "'" + shown(file_name(input)) + "', an input file"});
    }
  }
  return {};
}

namespace {

/// A path in one spelling: the real folder without links, and the file's own name, even if the file
/// is a link. If the folder does not exist, the path is only cleaned of "." and "..".
std::string place_of(const std::string& path) {
  std::error_code fault;
  const std::filesystem::path whole = std::filesystem::absolute(path, fault);
  if (fault) return path;  // the current folder was removed
  const auto parent = std::filesystem::canonical(whole.parent_path(), fault);
  // If the file is a link, the take states the name of the link and not that of its target.
  return ((fault ? whole.parent_path().lexically_normal() : parent) / whole.filename()).string();
}

/// The folder's path relative to the current folder: "demo/". Empty for the current folder.
std::string from_here(const std::string& folder) {
  std::error_code fault;
  const auto here = std::filesystem::canonical(".", fault);
  if (fault) return folder;
  const std::string near = std::filesystem::path(folder).lexically_relative(here).string();
  // The path ends in '/', so that a file's name can be appended.
  if (near.empty() || near == ".") return near.empty() ? folder : "";
  return near.ends_with('/') ? near : near + "/";
}

}  // namespace

std::string cut_common_folder(Manifest& manifest) {
  const std::vector<std::string*> paths = paths_in(manifest);
  if (paths.empty()) return "";
  // If the user typed only relative paths, the result is relative, too, so that messages show what
  // was typed.
  const bool relative = std::none_of(
      paths.begin(), paths.end(), [](const std::string* path) { return path->starts_with('/'); });
  for (std::string* path : paths) *path = place_of(*path);
  std::string common(folder(*paths.front()));
  for (const std::string* path : paths) {
    // The common part ends at a '/', so "take1/" and "take10/" share only the folder above them.
    while (!path->starts_with(common)) {
      common.pop_back();
      common = folder(common);
    }
  }
  // If the files share no folder, their paths become absolute.
  if (common == "/") return "";
  for (std::string* path : paths) path->erase(0, common.size());
  return relative ? from_here(common) : common;
}

std::vector<std::string> files_named(Manifest manifest, const std::string& folder) {
  std::vector<std::string> paths;
  for (const std::string* path : paths_in(manifest)) paths.push_back(path_in(folder, *path));
  return paths;
}

}  // namespace kinalign
