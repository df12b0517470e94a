// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/command_line.h"
#include "apps/cli/console.h"
#include "apps/cli/field_text.h"
#include "apps/cli/json_text.h"
#include "apps/cli/settings.h"
#include "apps/kinalign/verbs.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace kinalign {

namespace {

/// The options of `kinalign config`, which has none. make_verb() needs a type.
struct Config {};

/// A setting with its verb, name, value, and the place that sets it.
struct InForce {
  std::string verb, name, value, whence;
};

Usage describe(Config&) { return {}; }

/// The place that sets a value: a variable, a settings file, a flag, or "standard" for the default.
std::string whence(const std::string& name, Source source, const std::vector<SettingsFile>& files) {
  if (source == Source::environment) return variable_of(name);
  for (const SettingsFile& file : files) {
    if (file.source == source) return file.path;
  }
  return source == Source::flag ? flag_of(name) : "standard";
}

/// Appends the fields with their values and places. A field that `sources` does not contain has its
/// default.
void list(const Fields& fields, const std::string& verb, const Sources& sources,
          const std::vector<SettingsFile>& files, std::vector<InForce>& all) {
  for (const Field& field : fields) {
    const auto known = sources.find(field.name);
    const Source source = known == sources.end() ? Source::standard : known->second;
    all.push_back({verb, field.name, field_text(field), whence(field.name, source, files)});
  }
}

/// Adds the settings that a verb would use if it were called now.
Result<void> list_verb(const Verb& verb, const Call& call, const std::vector<SettingsFile>& files,
                       std::vector<InForce>& all) {
  Result<void> result;
  describe_verb(verb, [&](const Usage& usage) {
    // The present call has set only the options of `config`. The settings of another verb are
    // therefore applied here, to new options of that verb.
    const Settable settable{verb.page, usage.settings, {}};
    Sources sources;
    // Files come first, from the weakest to the strongest, then the environment, as in a real call.
    // apply_settings() does not override a stronger source.
    result = [&]() -> Result<void> {
      for (const SettingsFile& file : files) {
        KA_TRY(apply_settings(file, settable, call.verbs, sources));
      }
      return apply_environment(call.surroundings, settable, sources);
    }();
    list(usage.settings, verb.page.name, sources, files, all);
  });
  return result;
}

/// All settings: those that all verbs share, then the settings of each verb.
Result<std::vector<InForce>> all_in_force(const Call& call) {
  const auto files =
      KA_TRY(parse_settings(KA_TRY(find_settings(call.surroundings, call.common.config))));
  std::vector<InForce> all;
  // common_fields() returns `jobs` only for a page that takes it, so this page does. Below, fields
  // that a settings file may not set are removed.
  Common common = call.common;
  Fields everywhere = common_fields(
      common, {.name = "", .summary = "", .text = "", .examples = {}, .common = {"jobs"}});
  std::erase_if(everywhere, [](const Field& field) { return !is_common_setting(field.name); });
  list(everywhere, "", call.sources, files, all);
  for (const Verb& verb : call.verbs) KA_TRY(list_verb(verb, call, files, all));
  return all;
}

/// Prints all settings in aligned columns, or as JSON.
Result<int> run(Config&, Call& call) {
  // The widest name and value must be known before the first line is printed, so there are two
  // passes.
  const auto all = KA_TRY(all_in_force(call));
  auto settings = nlohmann::ordered_json::array();
  std::size_t name_width = 0;
  std::size_t value_width = 0;
  const auto full_name = [](const InForce& one) {
    return one.verb.empty() ? one.name : one.verb + "." + one.name;
  };
  for (const InForce& one : all) {
    name_width = std::max(name_width, full_name(one).size());
    value_width = std::max(value_width, one.value.size());
    settings.push_back(
        {{"verb", one.verb}, {"name", one.name}, {"value", one.value}, {"whence", one.whence}});
  }
  for (const InForce& one : all) {
    call.console.print(fmt::format("{:<{}}  {:<{}}  {}\n", full_name(one), name_width, one.value,
                                   value_width, one.whence));
  }
  call.console.print_json(json_text(nlohmann::ordered_json{{"settings", settings}}));
  return 0;
}

}  // namespace

/// The verb `kinalign config`.
Verb config_verb() {
  return make_verb<Config>(
      {.name = "config",
       .summary = "print all settings in use and where each comes from",
       .text = "The first of these places that sets an option decides: a flag; KINALIGN_<NAME> in "
               "the environment; the manifest; the nearest kinalign.toml in the current folder or "
               "above it; ~/.config/kinalign/config.toml.",
       .examples = {{"kinalign config", "all settings of all verbs"},
                    {"kinalign config --json", "the same for programs"}},
       .common = {"json", "jobs"}},
      describe, run);
}

}  // namespace kinalign
