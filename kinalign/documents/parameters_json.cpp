// SPDX-License-Identifier: Apache-2.0
#include "kinalign/documents/parameters_json.h"

#include "kinalign/syntax/value.h"
#include "kinalign/take/remembered_path.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <optional>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* schema = "kinalign.parameters/1";

// ---- conversion to JSON

/// Converts the value at an option's address to JSON. An absent optional value becomes null, so
/// that its key is written too.
struct ToJson {
  template <class Value>
  Json operator()(const Value* value) const {
    return *value;
  }
  template <class Value>
  Json operator()(const std::optional<Value>* value) const {
    return *value ? Json(**value) : Json(nullptr);
  }
};

Json fields_to_json(const Fields& fields) {
  // describe() returns the options in a fixed order, which becomes the order in the JSON.
  Json out = Json::object();
  for (const Field& field : fields) out[field.name] = std::visit(ToJson{}, field.value);
  return out;
}

/// Converts a stream: its name and files, then its options. The stream is copied, because
/// describe() needs addresses of values that it may change.
Json stream_to_json(StreamOptions stream) {
  Json out = {{"name", stream.name}, {"files", Json::array()}};
  for (const StreamFile& file : stream.files) {
    out["files"].push_back({{"path", file.path}, {"node", file.node}});
  }
  out.update(fields_to_json(describe(stream)));
  return out;
}

// ---- conversion from JSON

Value value_of(const Json& json, std::string key, std::string path) {
  // `line` stays 0, because JSON values are named by their path, such as streams[0].gap_ms.
  using Kind = Value::Kind;
  Value out{Kind::null, {}, {}, std::move(key), std::move(path)};
  // nlohmann may store an integer above INT64_MAX, which is too large for an option's integer.
  const bool whole = json.is_number_integer() &&
                     (!json.is_number_unsigned() || json.get<std::uint64_t>() <= INT64_MAX);
  if (json.is_boolean()) out.set(Kind::truth, json.get<bool>());
  if (json.is_string()) out.set(Kind::text, json.get<std::string>());
  if (whole) out.set(Kind::whole, json.get<std::int64_t>());
  if (json.is_number() && !whole) out.set(Kind::number, json.get<double>());
  if (json.is_array()) {
    out.kind = Kind::list;
    for (const Json& one : json) {
      // Elements of a list have no key.
      out.items.push_back(value_of(one, "", fmt::format("{}[{}]", out.path, out.items.size())));
    }
  }
  if (json.is_object()) {
    out.kind = Kind::table;
    for (const auto& [name, one] : json.items()) {
      out.items.push_back(value_of(one, name, out.path + (out.path.empty() ? "" : ".") + name));
    }
  }
  return out;
}

Result<void> streams_from_json(const Value& streams, Manifest& out) {
  if (streams.kind != Value::Kind::list) return wrong(streams, "a list");
  for (const Value& one : streams.items) {
    StreamOptions& stream = out.streams.emplace_back();
    const auto read_files = [&](const Value& files) -> Result<void> {
      if (files.kind != Value::Kind::list) return wrong(files, "a list");
      for (const Value& each : files.items) {
        StreamFile& file = stream.files.emplace_back();
        // The path is checked later, when the rest of the text is known to be correct.
        KA_TRY(read_options(each, {{"path", "", &file.path}, {"node", "", &file.node}}));
      }
      return {};
    };
    Fields fields = describe(stream);
    // In TOML the name is the key of the table. In JSON the streams are a list, so the name is a
    // member.
    fields.push_back({"name", "", &stream.name});
    KA_TRY(read_options(one, fields, {{"files", read_files}}));
  }
  return {};
}

Result<void> spaces_from_json(const Value& spaces, Manifest& out) {
  for (const Value& one : KA_TRY(entries_of(spaces))) {
    KA_TRY(read_options(one, describe(out.spaces[one.key])));
  }
  return {};
}

Result<Manifest> manifest_from(const Value& top) {
  Manifest out;
  const auto check_schema = [](const Value& value) -> Result<void> {
    if (KA_TRY(text_of(value)) == schema) return {};
    return wrong(value, std::string("\"") + schema + "\"");
  };
  if (!top.is_table()) return refuse("parameters as a table", shown(top));
  // Without a schema the version is unknown, and the keys could have other meanings.
  if (top.find({"schema"}) == nullptr) {
    return refuse(std::string("schema ") + schema, "none");
  }
  KA_TRY(
      read_options(top, describe(out),
                   {{"schema", check_schema},
                    {"align", [&](const Value& v) { return read_options(v, describe(out.align)); }},
                    {"streams", [&](const Value& v) { return streams_from_json(v, out); }},
                    {"spaces", [&](const Value& v) { return spaces_from_json(v, out); }}}));
  return out;
}

/// A take from another person must not make the program read files outside its folder.
Result<void> check_path(const std::string& path) {
  // A path inside the folder is not changed by remembered_path().
  if (remembered_path(path) == path) return {};
  return refuse("a path below the folder of the inputs", "'" + shown(path) + "'");
}

}  // namespace

std::string parameters_json(const Manifest& manifest) {
  Manifest copy = manifest;
  Json out = {{"schema", schema}};
  out.update(fields_to_json(describe(copy)));
  out["align"] = fields_to_json(describe(copy.align));
  out["streams"] = Json::array();
  for (const StreamOptions& stream : copy.streams) out["streams"].push_back(stream_to_json(stream));
  out["spaces"] = Json::object();
  for (auto& [name, space] : copy.spaces) out["spaces"][name] = fields_to_json(describe(space));
  // Bytes of file names that are not UTF-8 become U+FFFD.
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<Manifest> parse_parameters_json(std::string_view json) {
  // Takes of this program are nested a few levels deep. The limit protects value_of(), which is
  // recursive.
  constexpr int deepest = 32;
  bool deeper = false;
  const auto keep = [&deeper](int depth, Json::parse_event_t, const Json&) {
    deeper = deeper || depth > deepest;
    return !deeper;
  };
  const Json parsed = Json::parse(json, keep, false);
  if (deeper) return refuse("parameters as JSON", "too many brackets");
  if (parsed.is_discarded()) {
    return refuse("parameters as JSON", json.empty() ? "an empty text" : shown(json));
  }
  Manifest manifest = KA_TRY(manifest_from(value_of(parsed, "", "")));
  for (const StreamOptions& stream : manifest.streams) {
    KA_TRY(check_path(stream.layout));
    for (const StreamFile& file : stream.files) KA_TRY(check_path(file.path));
  }
  return manifest;
}

Manifest without_folders(Manifest manifest) {
  std::vector<std::string> paths;
  for (const StreamOptions& stream : manifest.streams) {
    for (const StreamFile& file : stream.files) paths.push_back(file.path);
  }
  const auto names = remembered_paths(paths);
  // All paths are processed together, because two files with the same name get different folders.
  for (StreamOptions& stream : manifest.streams) {
    stream.layout = remembered_path(stream.layout);
    for (StreamFile& file : stream.files) file.path = names.at(file.path);
  }
  return manifest;
}

}  // namespace kinalign
