// SPDX-License-Identifier: Apache-2.0
#include "kinalign/documents/manifest_toml.h"

#include "kinalign/core/nearest_name.h"
#include "kinalign/syntax/toml.h"

#include <algorithm>

namespace kinalign {

namespace {

/// Refuses a lab.toml that was given as a manifest by mistake. Both files name streams, but only
/// lab.toml has a table [device].
Result<void> check_purpose(const Value& top) {
  const Value* devices = top.find({"device"});
  if (devices == nullptr) return {};
  return at(*devices, "a manifest, recording.toml, with [stream.NAME]",
            "[device], of a lab.toml: kinalign record takes it as --config");
}

/// Reads files = { waist = "w.csv" } or files = ["a.csv", "b.csv"].
Result<void> read_files(const Value& value, std::vector<StreamFile>& out) {
  if (value.kind != Value::Kind::list && !value.is_table()) {
    return wrong(value, "a list of files or a table of nodes' files");
  }
  // In a table, the key names the node of each file. In a list, the files themselves name their
  // nodes.
  for (const Value& one : value.items) {
    out.push_back({KA_TRY(text_of(one)), value.is_table() ? one.key : ""});
  }
  return {};
}

/// Stores the line of each key, for messages. A key must have an effect even if its value is the
/// default, so the keys are needed too.
void keep_lines(const Value& table, KeyLines& lines) {
  for (const Value& entry : table.items) lines[entry.key] = entry.line;
}

Result<void> read_stream(const Value& stream, Manifest& manifest) {
  StreamOptions& out = manifest.streams.emplace_back();
  out.name = stream.key;
  // `file` is a short form of `files` with one entry.
  const auto read_file = [&](const Value& value) -> Result<void> {
    out.files.push_back({KA_TRY(text_of(value)), ""});
    return {};
  };
  KA_TRY(read_options(
      stream, describe(out),
      {{"file", read_file}, {"files", [&](const Value& v) { return read_files(v, out.files); }}}));
  keep_lines(stream, out.lines);
  // A stream without a file is refused with the line of its table.
  if (!out.files.empty()) return {};
  return at(stream, "file or files in [" + stream.path + "]", "none");
}

Result<void> read_streams(const Value& streams, Manifest& out) {
  for (const Value& stream : KA_TRY(entries_of(streams))) KA_TRY(read_stream(stream, out));
  return {};
}

Result<void> read_spaces(const Value& spaces, Manifest& out) {
  for (const Value& space : KA_TRY(entries_of(spaces))) {
    // The key of a space is the name of the stream that is moved.
    SpaceOptions& options = out.spaces[space.key];
    KA_TRY(read_options(space, describe(options)));
    keep_lines(space, options.lines);
  }
  return {};
}

/// Fails if the manifest refers to a stream that does not exist.
Result<void> check_names(const Value& top, const Manifest& manifest) {
  std::vector<std::string> known;
  for (const StreamOptions& stream : manifest.streams) known.push_back(stream.name);
  // `where`: the value in the file, whose line the error states.
  const auto check = [&](const std::string& stream, const Value* where) -> Result<void> {
    if (stream.empty() || where == nullptr) return {};  // the file does not name a stream
    if (std::find(known.begin(), known.end(), stream) != known.end()) return {};
    return at(*where, unknown_name(stream, "a stream of this file", known));
  };
  KA_TRY(check(manifest.align.reference, top.find({"align", "reference"})));
  for (const auto& [name, space] : manifest.spaces) {
    KA_TRY(check(name, top.find({"space", name})));
    KA_TRY(check(space.onto, top.find({"space", name, "onto"})));
  }
  return {};
}

/// Returns the tables of one stream as text.
std::string stream_text(const StreamOptions& stream) {
  std::string text = toml_head("stream", stream.name);
  if (!stream.files.empty()) text += files_toml(stream.files) + "\n";
  return text + toml_options(stream);
}

}  // namespace

Result<Manifest> read_manifest(std::string_view toml, std::string_view name,
                               const AlignOptions& unsaid) {
  Manifest out;
  // Options that [align] does not set keep these values.
  out.align = unsaid;
  KA_TRY(read_toml(toml, name, [&](const Value& top) -> Result<void> {
    // A lab.toml is recognised first. Otherwise its keys would be reported as unknown.
    KA_TRY(check_purpose(top));
    KA_TRY(read_options(
        top, describe(out),
        {{"align", [&](const Value& v) { return read_options(v, describe(out.align)); }},
         {"stream", [&](const Value& v) { return read_streams(v, out); }},
         {"space", [&](const Value& v) { return read_spaces(v, out); }}}));
    return check_names(top, out);
  }));
  return out;
}

std::string files_toml(const std::vector<StreamFile>& files) {
  // Either all files of a stream have a node, or none has a node.
  if (!files.empty() && !files.front().node.empty()) {
    // toml_table() sorts by key, so it can't keep the order of the files.
    std::string table;  // in the order of the files
    for (const StreamFile& file : files) {
      table += (table.empty() ? "" : ", ") + toml_key(file.node) + " = " + toml_string(file.path);
    }
    return "files = { " + table + " }";
  }
  if (files.size() == 1) return "file = " + toml_string(files.front().path);
  std::vector<std::string> paths;
  paths.reserve(files.size());
  for (const StreamFile& file : files) paths.push_back(file.path);
  return "files = " + toml_list(paths);
}

std::string select_toml(const std::map<std::string, std::string>& select) {
  return "select = " + toml_table(select);
}

std::string manifest_toml(const Manifest& manifest) {
  std::string text = toml_options(manifest);
  // A table without options is omitted.
  if (const std::string align = toml_options(manifest.align); !align.empty()) {
    text += "\n[align]\n" + align;
  }
  for (const StreamOptions& stream : manifest.streams) text += stream_text(stream);
  for (const auto& [stream, space] : manifest.spaces) {
    text += toml_head("space", stream) + toml_options(space);
  }
  return text;
}

}  // namespace kinalign
