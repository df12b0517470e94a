// SPDX-License-Identifier: Apache-2.0
// Completion scripts for bash, zsh and fish. Verbs, flags, choices and layouts are completed; every
// other word is completed as a file name.
#include "apps/cli/command_line.h"
#include "apps/cli/field_text.h"
#include "apps/cli/help.h"

#include "kinalign/sources/formats.h"

#include <fmt/format.h>

#include <algorithm>

namespace kinalign {

namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    if (!word.empty()) text += (text.empty() ? "" : " ") + word;
  }
  return text;
}

/// Calls use(page, usage, fields) for each verb. `fields` has all flags of the verb.
template <class Use>
void for_each_verb(const std::vector<Verb>& verbs, Use&& use) {
  for (const Verb& verb : verbs) {
    describe_verb(verb, [&](const Usage& usage) {
      Common common;
      Fields fields = usage.flags;
      fields.insert(fields.end(), usage.settings.begin(), usage.settings.end());
      const Fields everywhere = common_fields(common, verb.page);
      fields.insert(fields.end(), everywhere.begin(), everywhere.end());
      use(verb.page, usage, fields);
    });
  }
}

/// The words that a flag accepts. Empty if the flag accepts any text or a file.
std::vector<std::string> values_of(const Field& field) {
  // Fields do not list layouts; the registry of file formats does.
  if (field.name != "layout" && !field.name.ends_with("_layout")) return field.choices;
  const auto names = format_names();
  return {names.begin(), names.end()};
}

/// The first words of all verbs: single verbs, then groups.
std::string verb_names(const std::vector<Verb>& verbs) {
  std::vector<std::string> names;
  for (const Verb& verb : verbs) {
    if (group_of(verb.page.name).empty()) names.push_back(verb.page.name);
  }
  for (const std::string& group : groups_of(verbs)) names.push_back(group);
  return joined(names);
}

/// The choices of all positionals.
std::string choices_of(const Usage& usage) {
  std::vector<std::string> choices;
  for (const Positional& place : usage.positionals) {
    choices.insert(choices.end(), place.choices.begin(), place.choices.end());
  }
  return joined(choices);
}

/// Makes a text fit between single quotes of a shell: the characters that quotes or zsh's
/// _arguments would misread are removed. Correct escapes for three shells would be harder.
std::string quotable(std::string text) {
  std::erase_if(text, [](char c) { return c == '\'' || c == '[' || c == ']'; });
  std::replace(text.begin(), text.end(), ':', ',');
  return text;
}

/// Makes the bash script: one case for each flag that takes a value, and one for each verb. The
/// script compares each case with the verb and the word before the cursor.
std::string bash_script(const std::vector<Verb>& verbs) {
  std::string cases;
  for_each_verb(verbs, [&](const Page& page, const Usage& usage, const Fields& fields) {
    std::vector<std::string> words{"--help"};
    for (const Field& field : fields) {
      words.push_back(flag_of(field.name));
      if (is_switch(field)) continue;
      // -o is completed like --out.
      const std::string letter = field.name == "out" ? fmt::format("|'{} -o'", page.name) : "";
      cases += fmt::format("    '{} {}'{}) words='{}' ;;\n", page.name, flag_of(field.name), letter,
                           joined(values_of(field)));
    }
    cases += fmt::format("    '{} '*) [[ $word == -* ]] && words='{}' || words='{}' ;;\n",
                         page.name, joined(words), choices_of(usage));
  });
  std::string groups;
  for (const std::string& group : groups_of(verbs)) {
    groups += fmt::format(
        "  if [ \"$verb\" = {0} ] && [ \"$COMP_CWORD\" -gt 1 ]; then\n"
        "    first=2 verb=\"{0} ${{COMP_WORDS[2]}}\" words='{1}'\n  fi\n",
        group, joined(names_in(group, verbs)));
  }
  return fmt::format(
      "# bash completion of kinalign\n_kinalign() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} words='{} --help --version'\n"
      "  local first=1 verb=${{COMP_WORDS[1]}}\n{}"
      "  [ \"$COMP_CWORD\" -gt \"$first\" ] && case \"$verb ${{COMP_WORDS[COMP_CWORD-1]}}\" "
      "in\n"
      "{}  esac\n"
      "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n}}\n"
      "complete -o default -F _kinalign kinalign\n",
      verb_names(verbs), groups, cases);
}

/// Makes the zsh script, with one call of _arguments for each verb.
std::string zsh_script(const std::vector<Verb>& verbs) {
  std::string list;
  for (const Verb& verb : verbs) {
    if (!group_of(verb.page.name).empty()) continue;
    list += fmt::format("    '{}:{}'\n", verb.page.name, quotable(verb.page.summary));
  }
  std::string groups;
  for (const std::string& group : groups_of(verbs)) {
    list += fmt::format("    '{}:{}'\n", group, joined(names_in(group, verbs)));
    groups += fmt::format(
        "  if [[ $verb == {0} ]]; then\n    if (( CURRENT == 2 )); then\n      compadd {1}\n"
        "      return\n    fi\n    verb=\"{0} $words[2]\"\n    shift words\n    (( CURRENT-- ))\n"
        "  fi\n",
        group, joined(names_in(group, verbs)));
  }
  std::string cases;
  for_each_verb(verbs, [&](const Page& page, const Usage& usage, const Fields& fields) {
    cases += fmt::format("    '{}') _arguments", page.name);
    for (const Field& field : fields) {
      const std::string many =
          std::holds_alternative<std::vector<std::string>*>(field.value) ? "*" : "";
      cases +=
          fmt::format(" \\\n      '{}{}[{}]", many, flag_of(field.name), quotable(field.meaning));
      const std::string values = joined(values_of(field));
      if (!values.empty()) {
        cases += fmt::format(":value:({})", values);
      } else if (!is_switch(field)) {
        cases += ":value:_files";
      }
      cases += "'";
    }
    const std::string choices = choices_of(usage);
    cases += choices.empty() ? " \\\n      '*:file:_files' ;;\n"
                             : fmt::format(" \\\n      '*:word:({})' ;;\n", choices);
  });
  return fmt::format(
      "#compdef kinalign\n_kinalign() {{\n  local -a verbs=(\n{}  )\n"
      "  if (( CURRENT == 2 )); then\n    _describe verb verbs\n    return\n  fi\n"
      "  local verb=$words[2]\n  shift words\n  (( CURRENT-- ))\n{}  case $verb in\n{}  esac\n}}\n"
      "if [ \"$funcstack[1]\" = _kinalign ]; then\n  _kinalign \"$@\"\nelse\n"
      "  compdef _kinalign kinalign\nfi\n",
      list, groups, cases);
}

/// The lines that complete one verb's options and those positionals that have fixed choices. Each
/// line begins with the text `within`.
std::string fish_options(const std::string& within, const Usage& usage, const Fields& fields) {
  std::string text;
  for (const Field& field : fields) {
    text += fmt::format("{} -l {}", within, flag_of(field.name).substr(2));
    const std::string values = joined(values_of(field));
    if (!field.choices.empty()) text += " -x";
    if (field.choices.empty() && !is_switch(field)) text += " -r";
    if (!values.empty()) text += fmt::format(" -a '{}'", values);
    text += fmt::format(" -d '{}'\n", quotable(field.meaning));
  }
  for (const Positional& place : usage.positionals) {
    if (!place.choices.empty()) text += fmt::format("{} -a '{}'\n", within, joined(place.choices));
  }
  return text;
}

/// Makes the fish script, with a line for each verb and each flag. The condition of each line says
/// after which verb fish uses the line.
std::string fish_script(const std::vector<Verb>& verbs) {
  std::string text = "# fish completion of kinalign\n";
  for (const std::string& group : groups_of(verbs)) {
    text += fmt::format("complete -c kinalign -n __fish_use_subcommand -a {} -d '{}'\n", group,
                        joined(names_in(group, verbs)));
  }
  for_each_verb(verbs, [&](const Page& page, const Usage& usage, const Fields& fields) {
    const std::string group = group_of(page.name);
    const std::string word = group.empty() ? page.name : page.name.substr(group.size() + 1);
    std::string within =
        fmt::format("complete -c kinalign -n '__fish_seen_subcommand_from {}'", word);
    if (group.empty()) {
      text += fmt::format("complete -c kinalign -n __fish_use_subcommand -a {} -d '{}'\n", word,
                          quotable(page.summary));
    } else {
      text += fmt::format(
          "complete -c kinalign -n '__fish_seen_subcommand_from {}; and not "
          "__fish_seen_subcommand_from {}' -a {} -d '{}'\n",
          group, joined(names_in(group, verbs)), word, quotable(page.summary));
      within = fmt::format(
          "complete -c kinalign -n '__fish_seen_subcommand_from {}; and "
          "__fish_seen_subcommand_from {}'",
          group, word);
    }
    text += fish_options(within, usage, fields);
  });
  return text;
}

}  // namespace

std::string completion_script(const std::string& shell, const std::vector<Verb>& verbs) {
  if (shell == "zsh") return zsh_script(verbs);
  if (shell == "fish") return fish_script(verbs);
  return bash_script(verbs);
}

}  // namespace kinalign
