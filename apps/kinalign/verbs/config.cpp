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

/// `config` has no options of its own; make_verb() needs a type.
struct Config {};

/// A setting in force: its verb, name and value, and the place that sets it.
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

/// Appends the fields with their values and places. A field that is missing in `sources` has its
/// default.
void list(const Fields& fields, const std::string& verb, const Sources& sources,
          const std::vector<SettingsFile>& files, std::vector<InForce>& all) {
  for (const Field& field : fields) {
    const auto known = sources.find(field.name);
    const Source source = known == sources.end() ? Source::standard : known->second;
    all.push_back({verb, field.name, field_text(field), whence(field.name, source, files)});
  }
}

/// Adds a verb's settings, as its own call would find them.
Result<void> list_verb(const Verb& verb, const Call& call, const std::vector<SettingsFile>& files,
                       std::vector<InForce>& all) {
  Result<void> result;
  describe_verb(verb, [&](const Usage& usage) {
    // The real call has set only the options of `config`. Each other verb's settings are therefore
    // applied here, to a new set of its options.
    const Settable settable{verb.page, usage.settings, {}};
    Sources sources;
    // The order is that of a real call: files from the weakest to the strongest, then the
    // environment. apply_settings() keeps values of stronger sources.
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

/// All settings in force: those that all verbs share, then each verb's own.
Result<std::vector<InForce>> all_in_force(const Call& call) {
  const auto files =
      KA_TRY(parse_settings(KA_TRY(find_settings(call.surroundings, call.common.config))));
  std::vector<InForce> all;
  // common_fields() needs a page to choose from. This page takes `jobs`, so the list holds
  // everything that a settings file may set for all verbs.
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
  // Two passes: the columns can be aligned only if the widest name and value are known.
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
