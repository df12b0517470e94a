// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/inputs.h"

#include "kinalign/core/file_version.h"
#include "kinalign/core/files.h"
#include "kinalign/io/manifest_toml.h"
#include "kinalign/io/open_recording.h"

namespace kinalign {

Result<bool> is_take(FileSystem& files, const std::string& path) {
  InputFile file = KA_TRY(InputFile::open(files, path));
  const std::string_view piece = KA_TRY(file.next());
  return piece.starts_with("\x89HDF\r\n\x1a\n");
}

Result<std::pair<std::string, std::string>> split_pair(const std::string& text,
                                                       std::string_view expected) {
  const auto equals = text.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == text.size()) {
    return Failure(Error{"", 0, std::string(expected), "'" + shown(text) + "'"});
  }
  return std::pair{text.substr(0, equals), text.substr(equals + 1)};
}

Result<Manifest> load_manifest(FileSystem& files, const std::string& path,
                               const AlignOptions& unsaid) {
  constexpr std::size_t longest = std::size_t{1} << 20;
  const std::string text = KA_TRY(read_whole(files, path, longest));
  return read_manifest(text, path, unsaid);
}

Fields StreamFlags::fields() {
  Fields out = describe(options);
  out.push_back({"select", "rows of a table to take; may be repeated", &select});
  return out;
}

Result<StreamOptions> StreamFlags::stream(const std::vector<std::string>& paths) const {
  StreamOptions out = options;
  if (out.name.empty()) out.name = "stream";
  for (const std::string& path : paths) out.files.push_back({path, ""});
  for (const std::string& one : select) {
    const auto [column, value] = KA_TRY(split_pair(one, "--select COLUMN=VALUE"));
    out.select[column] = value;
  }
  return out;
}

Result<Recording> open_input(FileSystem& files, const std::string& path, const StreamFlags& flags,
                             const Progress& progress) {
  if (path.ends_with(".toml")) {
    const Manifest manifest = KA_TRY(load_manifest(files, path));
    return open_recording(files, manifest, std::string(folder(path)), progress);
  }
  Recording recording;
  const StreamOptions options = KA_TRY(flags.stream({path}));
  recording.streams = KA_TRY(open_streams(files, {options}, progress));
  return recording;
}

Result<void> keep_inputs(const std::string& out, const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    if (same_file(out, input)) {
      return Failure(Error{out, 0, "another name than those of the files it is made of",
                           "'" + shown(file_name(input)) + "', which is one of them"});
    }
  }
  return {};
}

std::vector<std::string> files_named(const Manifest& manifest, const std::string& folder) {
  std::vector<std::string> paths;
  const auto add = [&](const std::string& path) {
    paths.push_back(path.starts_with('/') ? path : folder + path);
  };
  for (const StreamOptions& stream : manifest.streams) {
    for (const StreamFile& file : stream.files) add(file.path);
    if (stream.layout.ends_with(".toml")) add(stream.layout);
  }
  return paths;
}

Error blame(const std::string& path) { return {path, 0, "a take that HDF5 can read", ""}; }

}  // namespace kinalign
