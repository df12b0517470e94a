// SPDX-License-Identifier: Apache-2.0
#include "kinalign/documents/parameters_json.h"

#include "kinalign/core/nearest_name.h"
#include "kinalign/documents/option_values.h"
#include "kinalign/take/remembered_path.h"

#include <nlohmann/json.hpp>

#include <optional>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* schema = "kinalign.parameters/1";

// ---- to JSON

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
  Json out = Json::object();
  for (const Field& field : fields) out[field.name] = std::visit(ToJson{}, field.value);
  return out;
}

/// A stream's files, selections and mountings, then its options.
Json stream_to_json(StreamOptions stream) {
  Json out = {{"name", stream.name}, {"files", Json::array()}};
  for (const StreamFile& file : stream.files) {
    out["files"].push_back({{"path", file.path}, {"node", file.node}});
  }
  out["select"] = stream.select;
  out["mounting"] = stream.mounting;
  out.update(fields_to_json(describe(stream)));
  return out;
}

Json space_to_json(SpaceOptions space) {
  Json out = fields_to_json(describe(space));
  out["rotation"] = space.rotation;
  out["translation"] = space.translation;
  out["joints"] = space.joints;
  return out;
}

// ---- from JSON; `at` is the path of the value, for messages

Failure wrong(const std::string& at, const std::string& wanted, const Json& found) {
  return Failure(
      Error{"", 0, wanted + " at " + shown(at), std::string("a JSON ") + found.type_name()});
}

/// The path of a member: "spaces.kinect".
std::string below(std::string place, std::string_view key) {
  place += '.';
  place += key;
  return place;
}

/// The value as an option's value; absent for other types of JSON.
std::optional<OptionValue> option_value(const Json& json) {
  if (json.is_boolean()) return json.get<bool>();
  if (json.is_number_unsigned() && json.get<std::uint64_t>() > INT64_MAX) return std::nullopt;
  if (json.is_number_integer()) return json.get<std::int64_t>();
  if (json.is_number()) return json.get<double>();
  if (json.is_string()) return json.get<std::string>();
  if (!json.is_array()) return std::nullopt;
  std::vector<std::string> texts;
  for (const Json& text : json) {
    if (!text.is_string()) return std::nullopt;
    texts.push_back(text.get<std::string>());
  }
  return texts;
}

Result<void> text_from(const Json& json, const std::string& at, std::string& to) {
  if (!json.is_string()) return wrong(at, "a text", json);
  to = json.get<std::string>();
  return {};
}

Result<void> map_from(const Json& json, const std::string& at,
                      std::map<std::string, std::string>& to) {
  if (!json.is_object()) return wrong(at, "an object", json);
  for (const auto& [key, value] : json.items()) KA_TRY(text_from(value, below(at, key), to[key]));
  return {};
}

Result<std::vector<double>> numbers_from(const Json& json, const std::string& at) {
  if (!json.is_array()) return wrong(at, "a list of numbers", json);
  std::vector<double> out;
  for (const Json& number : json) {
    if (!number.is_number()) return wrong(at, "a list of numbers", number);
    out.push_back(number.get<double>());
  }
  return out;
}

Result<std::vector<double>> rotation_from(const Json& json, const std::string& at) {
  auto out = KA_TRY(numbers_from(json, at));
  KA_TRY(check_rotation(at, out));
  return out;
}

Result<std::vector<double>> translation_from(const Json& json, const std::string& at) {
  auto out = KA_TRY(numbers_from(json, at));
  if (out.size() == 3) return out;
  return Failure(Error{"", 0, at + " as 3 numbers", std::to_string(out.size()) + " numbers"});
}

Result<void> mounting_from(const Json& json, const std::string& at, StreamOptions& to) {
  if (!json.is_object()) return wrong(at, "an object", json);
  for (const auto& [node, rotation] : json.items()) {
    to.mounting[node] = KA_TRY(rotation_from(rotation, below(at, node)));
  }
  return {};
}

/// Sets the option `name`. null is accepted only for an optional.
Result<void> field_from(const Json& json, const std::string& at, const Fields& fields,
                        const std::string& name) {
  const Field* field = find_field(fields, name);
  if (field == nullptr) {
    std::vector<std::string> known;
    for (const Field& one : fields) known.push_back(one.name);
    return Failure(unknown_name(at, "a known key", known));
  }
  if (json.is_null()) {
    const bool optional = std::holds_alternative<std::optional<double>*>(field->value) ||
                          std::holds_alternative<std::optional<std::int64_t>*>(field->value);
    return optional ? Result<void>() : wrong(at, "a value", json);
  }
  const auto value = option_value(json);
  if (!value) return wrong(at, "an option's value", json);
  return assign(*field, *value);
}

/// Reads a list of files.
Result<void> files_from(const Json& json, const std::string& at, std::vector<StreamFile>& to) {
  if (!json.is_array()) return wrong(at, "a list", json);
  for (const Json& one : json) {
    if (!one.is_object()) return wrong(at, "a list of objects", one);
    StreamFile& file = to.emplace_back();
    for (const auto& [key, value] : one.items()) {
      if (key != "path" && key != "node") {
        return Failure(unknown_name(key, "a known key at " + at, {"path", "node"}));
      }
      KA_TRY(text_from(value, below(at, key), key == "path" ? file.path : file.node));
    }
  }
  return {};
}

/// Reads a stream; an unknown key fails.
Result<StreamOptions> stream_from(const Json& json, const std::string& at) {
  if (!json.is_object()) return wrong(at, "an object", json);
  StreamOptions out;
  const Fields fields = describe(out);
  for (const auto& [key, value] : json.items()) {
    const std::string here = below(at, key);
    if (key == "name") {
      KA_TRY(text_from(value, here, out.name));
    } else if (key == "files") {
      KA_TRY(files_from(value, here, out.files));
    } else if (key == "select") {
      KA_TRY(map_from(value, here, out.select));
    } else if (key == "mounting") {
      KA_TRY(mounting_from(value, here, out));
    } else {
      KA_TRY(field_from(value, here, fields, key));
    }
  }
  return out;
}

Result<SpaceOptions> space_from(const Json& json, const std::string& at) {
  if (!json.is_object()) return wrong(at, "an object", json);
  SpaceOptions out;
  const Fields fields = describe(out);
  for (const auto& [key, value] : json.items()) {
    const std::string here = below(at, key);
    const bool given = key == "rotation" || key == "translation";
    if (given && value == Json::array()) continue;  // an empty list means none
    if (key == "rotation") {
      out.rotation = KA_TRY(rotation_from(value, here));
    } else if (key == "translation") {
      out.translation = KA_TRY(translation_from(value, here));
    } else if (key == "joints") {
      KA_TRY(map_from(value, here, out.joints));
    } else {
      KA_TRY(field_from(value, here, fields, key));
    }
  }
  return out;
}

Result<void> streams_from(const Json& json, Manifest& out) {
  if (!json.is_array()) return wrong("streams", "a list", json);
  for (const Json& one : json) {
    const std::string at = "streams[" + std::to_string(out.streams.size()) + "]";
    out.streams.push_back(KA_TRY(stream_from(one, at)));
  }
  return {};
}

Result<void> spaces_from(const Json& json, Manifest& out) {
  if (!json.is_object()) return wrong("spaces", "an object", json);
  for (const auto& [name, one] : json.items()) {
    out.spaces[name] = KA_TRY(space_from(one, "spaces." + name));
  }
  return {};
}

Result<void> align_from(const Json& json, AlignOptions& out) {
  if (!json.is_object()) return wrong("align", "an object", json);
  const Fields fields = describe(out);
  for (const auto& [key, value] : json.items()) {
    KA_TRY(field_from(value, "align." + key, fields, key));
  }
  return {};
}

/// Reads the whole manifest; an unknown key or another schema fails.
Result<Manifest> manifest_from(const Json& json) {
  if (!json.is_object()) return wrong("the top", "an object", json);
  if (json.value("schema", Json()) != schema) {
    return Failure(Error{"", 0, std::string("schema ") + schema, "another one"});
  }
  Manifest out;
  for (const auto& [key, value] : json.items()) {
    if (key == "subject" || key == "action") {
      KA_TRY(text_from(value, key, key == "subject" ? out.subject : out.action));
    } else if (key == "streams") {
      KA_TRY(streams_from(value, out));
    } else if (key == "spaces") {
      KA_TRY(spaces_from(value, out));
    } else if (key == "align") {
      KA_TRY(align_from(value, out.align));
    } else if (key != "schema") {
      return Failure(
          unknown_name(key, "a known key", {"subject", "action", "streams", "spaces", "align"}));
    }
  }
  return out;
}

/// True if brackets outside of strings are nested deeper than `most`. The parser recurses; this
/// check does not.
bool deeper_than(std::string_view json, int most) {
  int depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_text && c == '\\') ++i;
    if (c == '"') in_text = !in_text;
    if (in_text) continue;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > most) return true;
  }
  return false;
}

/// A take from another person must not make the program read files elsewhere.
Result<void> check_path(const std::string& path) {
  if (remembered_path(path) == path) return {};
  return Failure(Error{"", 0, "a path below the folder of the inputs", "'" + shown(path) + "'"});
}

}  // namespace

std::string parameters_json(const Manifest& manifest) {
  Json out = {{"schema", schema}, {"subject", manifest.subject}, {"action", manifest.action}};
  AlignOptions align = manifest.align;
  out["align"] = fields_to_json(describe(align));
  out["streams"] = Json::array();
  for (const StreamOptions& stream : manifest.streams) {
    out["streams"].push_back(stream_to_json(stream));
  }
  out["spaces"] = Json::object();
  for (const auto& [name, space] : manifest.spaces) out["spaces"][name] = space_to_json(space);
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<Manifest> parse_parameters_json(std::string_view json) {
  if (deeper_than(json, 32))
    return Failure(Error{"", 0, "parameters as JSON", "too many brackets"});
  const Json parsed = Json::parse(json, nullptr, false);
  if (parsed.is_discarded()) {
    return Failure(
        Error{"", 0, "parameters as JSON", json.empty() ? "an empty text" : shown(json)});
  }
  Manifest manifest = KA_TRY(manifest_from(parsed));
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
  for (StreamOptions& stream : manifest.streams) {
    stream.layout = remembered_path(stream.layout);
    for (StreamFile& file : stream.files) file.path = names.at(file.path);
  }
  return manifest;
}

}  // namespace kinalign
