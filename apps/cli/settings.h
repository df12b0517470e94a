// SPDX-License-Identifier: Apache-2.0
// Options that need not be typed each time. The order of precedence: flags, KINALIGN_<NAME> in the
// environment, a manifest's [align], the project's kinalign.toml (in the current folder or the
// nearest one above it), the user's ~/.config/kinalign/config.toml.
#pragma once

#include "apps/cli/verb.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A key of a settings file with its line, so that an error can name both.
struct Setting {
  std::string verb;  // the table that it stands in; empty: for every verb
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

/// The path of the project's file: `config`, else the value of KINALIGN_CONFIG, else kinalign.toml
/// in the current folder or above it. Empty if there is none.
std::string project_settings(const Surroundings& surroundings, const std::string& config);

/// The user's file and the project's, if they exist. `config` replaces the project's file unless it
/// is empty. Fails if a file can't be read.
/// The user's file comes first, so that the project's wins.
Result<std::vector<SettingsText>> find_settings(const Surroundings& surroundings,
                                                const std::string& config);

/// Reads settings: `jobs = 4` for every verb, `[align]` with `gap_ms = 50` for one. Any other
/// content is wrong use.
Result<SettingsFile> parse_settings(const SettingsText& file);
Result<std::vector<SettingsFile>> parse_settings(const std::vector<SettingsText>& files);

/// The pages to read after an error in a settings file.
inline constexpr std::string_view settings_pages =
    "docs/commands.md describes a settings file, docs/formats/lab_toml.md describes a lab file";

/// The options that a verb's table and the beginning of a file may set.
struct Settable {
  const Page& page;
  const Fields& settings;  // the verb's
  const Fields& common;
};

/// Sets the options that no stronger source has set, and adds them to `sources`. Fails on unknown
/// names.
Result<void> apply_settings(const SettingsFile& file, const Settable& settable,
                            const std::vector<Verb>& verbs, Sources& sources);
Result<void> apply_environment(const Surroundings& surroundings, const Settable& settable,
                               Sources& sources);

/// The place that sets an option of the verb without a flag: "lab.toml" with the line, or
/// "KINALIGN_X". No file if a flag or nothing sets it.
struct SettingPlace {
  std::string file;
  std::int64_t line = 0;
};
SettingPlace setting_place(const std::string& verb, const std::string& name, const Call& call);

}  // namespace kinalign
