// SPDX-License-Identifier: Apache-2.0
// Options that need not be typed each time. Flags win over KINALIGN_<NAME> in the environment, that
// over a manifest's [align], that over the project's kinalign.toml (in the current folder or the
// nearest one above it), that over the user's ~/.config/kinalign/config.toml.
#pragma once

#include "apps/cli/verb.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

struct Setting {
  std::string verb;  // the table it stands in; empty: for every verb
  std::string name;
  std::vector<std::string> values;
  std::int64_t line = 0;
};

struct SettingsFile {
  std::string path;
  Source source = Source::user;
  std::vector<Setting> settings;
};

/// A file of settings as it stands.
struct SettingsText {
  std::string path;
  Source source = Source::user;
  std::string text;
};

/// The path of the project's file: `config`, else what KINALIGN_CONFIG names, else kinalign.toml in
/// the current folder or above it; empty: there is none.
std::string project_settings(const Surroundings& surroundings, const std::string& config);

/// The user's file and the project's (`config`, where not empty, in its place), where they exist.
/// Fails where one can't be read.
Result<std::vector<SettingsText>> find_settings(const Surroundings& surroundings,
                                                const std::string& config);

/// `jobs = 4` for every verb, `[align]` with `gap_ms = 50` for one. Fails where the text says
/// something else, which is wrong use.
Result<SettingsFile> parse_settings(const SettingsText& file);
Result<std::vector<SettingsFile>> parse_settings(const std::vector<SettingsText>& files);

/// Where to read on after an error in such a file.
inline constexpr std::string_view settings_pages =
    "docs/commands.md says what a file of settings has, docs/recording.md what one of a lab";

/// Options that a verb's table and the front of a file may set.
struct Settable {
  const Page& page;
  const Fields& settings;  // of the verb
  const Fields& common;
};

/// Sets what no later source has set; `sources` grows. Fails on names that nobody knows.
Result<void> apply_settings(const SettingsFile& file, const Settable& settable,
                            const std::vector<Verb>& verbs, Sources& sources);
Result<void> apply_environment(const Surroundings& surroundings, const Settable& settable,
                               Sources& sources);

/// Where an option of the verb stands that no flag gave: "lab.toml" with the line, or "KINALIGN_X";
/// no file where a flag gave it, or nobody.
struct SettingPlace {
  std::string file;
  std::int64_t line = 0;
};
SettingPlace setting_place(const std::string& verb, const std::string& name, const Call& call);

}  // namespace kinalign
