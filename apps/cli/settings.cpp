// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/settings.h"

#include "apps/cli/command_line.h"
#include "apps/cli/field_text.h"

#include "kinalign/documents/toml_entries.h"

#include <toml++/toml.h>
#include <unistd.h>

#include <algorithm>
#include <optional>

namespace kinalign {

namespace {

/// A larger settings file is refused.
constexpr std::size_t most_bytes = std::size_t{1} << 20;

std::int64_t line_of(const toml::node& node) { return node.source().begin.line; }

/// A TOML value as text, in the form that set_field() reads. Absent for tables, arrays and dates.
std::optional<std::string> scalar_text(const toml::node& node) {
  if (node.is_string()) return node.value<std::string>();
  if (const auto truth = node.value<bool>(); node.is_boolean()) return *truth ? "true" : "false";
  if (const auto whole = node.value<std::int64_t>(); node.is_integer()) {
    return std::to_string(*whole);
  }
  if (const auto number = node.value<double>(); node.is_floating_point()) {
    double value = *number;
    return field_text(Field{"", "", &value});
  }
  return std::nullopt;
}

/// The values of a key; an array gives several.
Result<Setting> setting_of(const std::string& path, const toml::key& key, const toml::node& node) {
  Setting setting{"", std::string(key.str()), {}, line_of(node)};
  const auto add = [&](const toml::node& one) -> Result<void> {
    auto text = scalar_text(one);
    if (!text) {
      return Failure(Error{path, setting.line, "a number, a text or true or false",
                           "something else for " + setting.name});
    }
    setting.values.push_back(std::move(*text));
    return {};
  };
  if (const toml::array* many = node.as_array()) {
    for (const toml::node& one : *many) KA_TRY(add(one));
  } else {
    KA_TRY(add(node));
  }
  return setting;
}

/// The error for a table within a table. Only devices of a lab may have one; people often give a
/// manifest instead of a lab's file.
Failure no_table(const std::string& path, const toml::node& node, const std::string& name) {
  if (name.starts_with("stream.") || name.starts_with("space.")) {
    return Failure(Error{path, line_of(node), "settings, or a lab's devices",
                         "[" + name + "] of a manifest, which is for kinalign align"});
  }
  const auto dot = name.find('.');
  const std::string device = dot == std::string::npos ? ".NAME" : name.substr(dot);
  return Failure(Error{path, line_of(node), "settings, or a lab's device as [device" + device + "]",
                       "[" + name + "]"});
}

/// Adds the settings of a verb's table.
Result<void> add_table(const toml::key& key, const toml::table& table, SettingsFile& file) {
  for (const auto& [inner_key, inner] : table) {
    const toml::table* within = inner.as_table();
    if (within != nullptr && !within->is_inline()) {
      return no_table(file.path, inner, shown(key.str()) + "." + shown(inner_key.str()));
    }
    Setting setting = KA_TRY(setting_of(file.path, inner_key, inner));
    setting.verb = key.str();
    file.settings.push_back(std::move(setting));
  }
  return {};
}

Result<SettingsFile> settings_of(const toml::table& all, SettingsFile file) {
  for (const auto& [key, node] : all) {
    if (key == "device" && node.is_table()) continue;  // documents/lab_toml.h reads a lab's devices
    if (node.is_array_of_tables()) {
      return no_table(file.path, node, "[" + shown(key.str()) + "]");
    }
    if (const toml::table* table = node.as_table()) {
      KA_TRY(add_table(key, *table, file));
    } else {
      file.settings.push_back(KA_TRY(setting_of(file.path, key, node)));
    }
  }
  return file;
}

bool there(const std::string& path) { return ::access(path.c_str(), F_OK) == 0; }

std::string users_file(const Surroundings& surroundings) {
  const std::string config = surroundings.variable("XDG_CONFIG_HOME");
  if (!config.empty()) return config + "/kinalign/config.toml";
  const std::string home = surroundings.variable("HOME");
  return home.empty() ? "" : home + "/.config/kinalign/config.toml";
}

std::string projects_file(std::string folder) {
  for (;;) {
    std::string path = folder + (folder.ends_with('/') ? "" : "/") + "kinalign.toml";
    if (there(path)) return path;
    const auto slash = folder.rfind('/');
    if (slash == std::string::npos || folder.size() <= 1) return "";
    folder.resize(std::max<std::size_t>(slash, 1));
  }
}

const Field* named(const Fields& fields, const std::string& name) {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [&](const Field& field) { return field.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

Result<void> set_all(const Field& field, const std::vector<std::string>& values) {
  auto* const* many = std::get_if<std::vector<std::string>*>(&field.value);
  if (many != nullptr) (*many)->clear();
  if (many == nullptr && values.size() != 1) {
    return Failure(Error{"", 0, "one value for " + field.name, std::to_string(values.size())});
  }
  for (const std::string& value : values) KA_TRY(set_field(field, value));
  return {};
}

Failure unknown(const SettingsFile& file, const Setting& setting,
                const std::vector<std::string>& known, const std::string& expected) {
  const std::string& word = expected == "a verb" ? setting.verb : setting.name;
  const std::string near = suggestion(word, known);
  return Failure(Error{file.path, setting.line, expected + (near.empty() ? "" : " (" + near + ")"),
                       shown(word)});
}

/// Refuses unknown names. Settings of other verbs are only checked for the verb's name.
Result<void> check_name(const SettingsFile& file, const Setting& setting, const Settable& settable,
                        const std::vector<Verb>& verbs) {
  std::vector<std::string> known;
  if (setting.verb.empty()) {
    known = {"jobs", "quiet", "verbose", "color"};
    return is_common_setting(setting.name)
               ? Result<void>{}
               : unknown(file, setting, known, "a setting of all verbs");
  }
  for (const Verb& verb : verbs) known.push_back(verb.page.name);
  if (std::find(known.begin(), known.end(), setting.verb) == known.end()) {
    known.emplace_back("device");
    return unknown(file, setting, known, "a verb");
  }
  if (setting.verb != settable.page.name || named(settable.settings, setting.name) != nullptr) {
    return {};
  }
  known.clear();
  for (const Field& field : settable.settings) known.push_back(field.name);
  return unknown(file, setting, known, "a setting of " + setting.verb);
}

}  // namespace

Result<SettingsFile> parse_settings(const SettingsText& file) {
  try {
    return settings_of(toml::parse(file.text, file.path), SettingsFile{file.path, file.source, {}});
  } catch (const toml::parse_error& error) {
    const auto line = static_cast<std::int64_t>(error.source().begin.line);
    return Failure(Error{file.path, line, "TOML" + quotes_advice(file.text, line),
                         "a fault in it: " + std::string(error.description())});
  }
}

Result<std::vector<SettingsFile>> parse_settings(const std::vector<SettingsText>& files) {
  std::vector<SettingsFile> parsed;
  parsed.reserve(files.size());
  for (const SettingsText& file : files) parsed.push_back(KA_TRY(parse_settings(file)));
  return parsed;
}

std::string project_settings(const Surroundings& surroundings, const std::string& config) {
  const std::string named = config.empty() ? surroundings.variable("KINALIGN_CONFIG") : config;
  return named.empty() ? projects_file(surroundings.folder) : named;
}

Result<std::vector<SettingsText>> find_settings(const Surroundings& surroundings,
                                                const std::string& config) {
  std::vector<SettingsText> found;
  const auto read = [&](const std::string& path, Source source) -> Result<void> {
    found.push_back({path, source, KA_TRY(read_whole(surroundings.files, path, most_bytes))});
    return {};
  };
  const std::string users = users_file(surroundings);
  if (!users.empty() && there(users)) KA_TRY(read(users, Source::user));
  const std::string projects = project_settings(surroundings, config);
  if (!projects.empty()) KA_TRY(read(projects, Source::project));
  return found;
}

Result<void> apply_settings(const SettingsFile& file, const Settable& settable,
                            const std::vector<Verb>& verbs, Sources& sources) {
  for (const Setting& setting : file.settings) {
    KA_TRY(check_name(file, setting, settable, verbs));
    if (!setting.verb.empty() && setting.verb != settable.page.name) continue;
    const Fields& fields = setting.verb.empty() ? settable.common : settable.settings;
    const Field* field = named(fields, setting.name);
    if (field == nullptr) continue;  // a common setting that this verb does not take
    const auto known = sources.find(setting.name);
    if (known != sources.end() && known->second > file.source) continue;
    KA_TRY(set_all(*field, setting.values).map_error([&](Error error) {
      error.file = file.path;
      error.line = setting.line;
      return error;
    }));
    sources[setting.name] = file.source;
  }
  return {};
}

/// An empty variable counts as not set. The environment wins over files, and a flag over the
/// environment.
Result<void> apply_environment(const Surroundings& surroundings, const Settable& settable,
                               Sources& sources) {
  for (const Fields* fields : {&settable.settings, &settable.common}) {
    for (const Field& field : *fields) {
      if (fields == &settable.common && !is_common_setting(field.name)) continue;
      const auto known = sources.find(field.name);
      if (known != sources.end() && known->second == Source::flag) continue;
      const std::string text = surroundings.variable(variable_of(field.name));
      if (text.empty()) continue;
      KA_TRY(set_all(field, {text}).map_error([&](Error error) {
        error.file = variable_of(field.name);
        return error;
      }));
      sources[field.name] = Source::environment;
    }
  }
  return {};
}

/// Reads the files again, since options keep no line numbers.
SettingPlace setting_place(const std::string& verb, const std::string& name, const Call& call) {
  const auto source = call.sources.find(name);
  if (source == call.sources.end() || source->second == Source::flag) return {};
  if (source->second == Source::environment) return {variable_of(name)};
  const auto texts = find_settings(call.surroundings, call.common.config);
  if (!texts) return {};
  const auto files = parse_settings(*texts);
  if (!files) return {};
  for (const SettingsFile& file : *files) {
    if (file.source != source->second) continue;
    for (const Setting& setting : file.settings) {
      if (setting.verb == verb && setting.name == name) return {file.path, setting.line};
    }
  }
  return {};
}

}  // namespace kinalign
