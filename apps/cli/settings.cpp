// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/settings.h"

#include "apps/cli/command_line.h"
#include "apps/cli/field_text.h"

#include "kinalign/core/find_named.h"
#include "kinalign/syntax/toml.h"

#include <unistd.h>

#include <algorithm>

namespace kinalign {

namespace {

/// Larger settings files are refused.
constexpr std::size_t most_bytes = std::size_t{1} << 20;

/// The error for a table within a table. Only the devices of a lab file may have such tables.
/// People often give a manifest where a lab file is expected.
Failure no_table(const Value& value) {
  if (value.path.starts_with("stream.") || value.path.starts_with("space.")) {
    return at(value,
              Error{"", 0, "settings, or a lab's devices",
                    "[" + shown(value.path) + "], which belongs in a manifest for kinalign align"});
  }
  const bool in_list = value.path == value.key;  // a list of tables: [[device]]
  return at(value, Error{"", 0,
                         "settings, or a lab's device as [device." +
                             (in_list ? "NAME" : shown(value.key)) + "]",
                         in_list ? "[[" + shown(value.key) + "]]" : "[" + shown(value.path) + "]"});
}

/// A TOML value as text that set_field() can read. Flags, variables and files all give text, so
/// set_field() checks the range and choices for all of them.
Result<std::string> scalar_text(const Value& value) {
  using Kind = Value::Kind;
  if (value.kind == Kind::text) return text_of(value);
  if (value.kind == Kind::truth || value.kind == Kind::whole || value.kind == Kind::number) {
    return shown(value);
  }
  if (value.is_table()) return no_table(value);
  return at(value,
            Error{"", 0, "a number, a text or true or false", "something else for " + value.key});
}

/// The setting that one TOML value gives. A list gives several values.
Result<Setting> setting_of(const std::string& verb, const Value& value) {
  Setting setting{verb, value.key, {}, value.line};
  if (value.kind != Value::Kind::list) {
    setting.values.push_back(KA_TRY(scalar_text(value)));
    return setting;
  }
  for (const Value& one : value.items) setting.values.push_back(KA_TRY(scalar_text(one)));
  return setting;
}

/// Adds one setting that counts for every verb, or all settings in the table of one verb.
Result<void> add_settings(const Value& value, SettingsFile& file) {
  if (!value.is_table()) {
    file.settings.push_back(KA_TRY(setting_of("", value)));
    return {};
  }
  for (const Value& inner : value.items) {
    file.settings.push_back(KA_TRY(setting_of(value.key, inner)));
  }
  return {};
}

bool there(const std::string& path) { return ::access(path.c_str(), F_OK) == 0; }

/// The user's settings file. The XDG Base Directory Specification puts it in $XDG_CONFIG_HOME, or
/// in ~/.config if that variable is empty.
std::string users_file(const Surroundings& surroundings) {
  const std::string config = surroundings.variable("XDG_CONFIG_HOME");
  if (!config.empty()) return config + "/kinalign/config.toml";
  const std::string home = surroundings.variable("HOME");
  return home.empty() ? "" : home + "/.config/kinalign/config.toml";
}

/// Searches `folder` and all folders above it for kinalign.toml, as git searches for its
/// repository.
std::string projects_file(std::string folder) {
  for (;;) {
    std::string path = folder + (folder.ends_with('/') ? "" : "/") + "kinalign.toml";
    if (there(path)) return path;
    const auto slash = folder.rfind('/');
    if (slash == std::string::npos || folder.size() <= 1) return "";
    folder.resize(std::max<std::size_t>(slash, 1));
  }
}

Result<void> set_all(const Field& field, const std::vector<std::string>& values) {
  auto* const* many = std::get_if<std::vector<std::string>*>(&field.value);
  // A list in a file replaces the list of a weaker source and does not add to it.
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

/// Refuses unknown names. For settings of other verbs only the name of the verb is checked.
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
  // One settings file serves all verbs, but only the names of the running verb's settings are known
  // here.
  if (setting.verb != settable.page.name ||
      find_named(settable.settings, setting.name) != nullptr) {
    return {};
  }
  known.clear();
  for (const Field& field : settable.settings) known.push_back(field.name);
  return unknown(file, setting, known, "a setting of " + setting.verb);
}

}  // namespace

Result<SettingsFile> parse_settings(const SettingsText& file) {
  SettingsFile out{file.path, file.source, {}};
  KA_TRY(read_toml(file.text, file.path, [&](const Value& top) -> Result<void> {
    for (const Value& value : top.items) {
      // A lab file is a settings file that also describes devices. documents/lab_toml.h reads the
      // devices.
      if (value.key == "device" && value.is_table()) continue;  // documents/lab_toml.h reads them
      KA_TRY(add_settings(value, out));
    }
    return {};
  }));
  return out;
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
    const Field* field = find_named(fields, setting.name);
    if (field == nullptr) continue;  // a common setting that this verb does not take
    const auto known = sources.find(setting.name);
    // The weakest file is applied first. Flags were set before all files and are kept.
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

/// Sets options from environment variables. A variable overrides files, and a flag overrides a
/// variable. An empty variable counts as not set.
Result<void> apply_environment(const Surroundings& surroundings, const Settable& settable,
                               Sources& sources) {
  for (const Fields* fields : {&settable.settings, &settable.common}) {
    for (const Field& field : *fields) {
      // Other common options, such as out and force, can be given on the command line only.
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

/// Reads the settings files again, because options do not store line numbers. Verbs call it when a
/// later check finds a wrong setting, so that the message names the setting's line.
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
