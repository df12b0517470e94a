// SPDX-License-Identifier: Apache-2.0
// Settings: options that need not be typed each time. The strongest source wins. From strong to
// weak: flags, the variables KINALIGN_<NAME>, the [align] table of a manifest, the project's
// kinalign.toml (in the current folder or the nearest folder above), the user's
// ~/.config/kinalign/config.toml.
#pragma once

#include "apps/cli/verb.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A setting in a file, with its line, so that an error can name both.
struct Setting {
  std::string verb;  // the table that the key stands in; empty: the setting counts for every verb
  std::string name;
  std::vector<std::string> values;
  std::int64_t line = 0;
};

struct SettingsFile {
  std::string path;
  Source source = Source::user;
  std::vector<Setting> settings;
};

/// The text of a settings file.
struct SettingsText {
  std::string path;
  Source source = Source::user;
  std::string text;
};

/// The path of the project's settings file: `config`, else the value of KINALIGN_CONFIG, else
/// kinalign.toml in the current folder or a folder above it. Empty if there is no such file.
std::string project_settings(const Surroundings& surroundings, const std::string& config);

/// Reads the user's and the project's settings files, if they exist. A `config` that is not empty
/// replaces the project's file. Fails if a file can't be read. The user's file comes first, so that
/// the project's file overrides it.
Result<std::vector<SettingsText>> find_settings(const Surroundings& surroundings,
                                                const std::string& config);

/// Parses settings: `jobs = 4` counts for every verb, `gap_ms = 50` below `[align]` for one verb.
/// Any other content is wrong use.
Result<SettingsFile> parse_settings(const SettingsText& file);
Result<std::vector<SettingsFile>> parse_settings(const std::vector<SettingsText>& files);

/// The manual pages that a message names after an error in a settings file.
inline constexpr std::string_view settings_pages =
    "docs/commands.md describes a settings file, docs/formats/lab_toml.md describes a lab file";

/// The options that settings files and variables may set for one verb.
struct Settable {
  const Page& page;
  const Fields& settings;  // the verb's own settings
  const Fields& common;
};

/// Sets the options that no stronger source has set, and notes their source in `sources`. Fails if
/// the file has an unknown name.
Result<void> apply_settings(const SettingsFile& file, const Settable& settable,
                            const std::vector<Verb>& verbs, Sources& sources);
Result<void> apply_environment(const Surroundings& surroundings, const Settable& settable,
                               Sources& sources);

/// The place that sets the verb's option: a settings file with the line, or a variable
/// "KINALIGN_X". The file is empty if a flag sets the option, or nothing does.
struct SettingPlace {
  std::string file;
  std::int64_t line = 0;
};
SettingPlace setting_place(const std::string& verb, const std::string& name, const Call& call);

}  // namespace kinalign
