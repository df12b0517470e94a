// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/command_line.h"

#include "apps/cli/field_text.h"

#include "kinalign/core/nearest_name.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace kinalign {

namespace {

constexpr std::array<std::pair<char, std::string_view>, 4> letters{
    {{'o', "out"}, {'q', "quiet"}, {'v', "verbose"}, {'h', "help"}}};

/// A word such as -12.5 is a number and not a flag: in `--yaw -12.5` it is the value of --yaw.
bool looks_like_a_flag(std::string_view word) {
  return word.size() > 1 && word[0] == '-' && word.find_first_of("0123456789.") != 1;
}

/// Parses the words of one command line in one pass. `at_` is the index of the current word.
/// set_bare() moves `at_` on if the next word is the flag's value. `plain_` collects the words that
/// are no flags. They are given to the positionals at the end, when their number is known.
class Walk {
 public:
  Walk(const std::vector<std::string>& words, const Usage& usage, const Fields& common)
      : words_(words), usage_(usage) {
    for (const Fields* some : {&usage.flags, &usage.settings, &common}) {
      for (const Field& field : *some) fields_.push_back(&field);
    }
  }

  // Flags may stand between other words. After "--" no word is taken as a flag.
  Result<Parsed> parse() {
    bool flags = true;
    for (; at_ < words_.size(); ++at_) {
      const std::string& word = words_[at_];
      if (flags && word == "--") {
        flags = false;
      } else if (flags && looks_like_a_flag(word)) {
        KA_TRY(word.starts_with("--") ? long_flag(word) : letter(word));
        if (parsed_.help) return std::move(parsed_);
      } else {
        plain_.push_back(word);
      }
    }
    KA_TRY(place_words());
    return std::move(parsed_);
  }

 private:
  // Parses a flag with two dashes: "--flag", "--flag=value" or "--no-flag".
  Result<void> long_flag(const std::string& word) {
    const auto equals = word.find('=');
    const std::string flag = word.substr(0, equals);
    const bool has_value = equals != std::string::npos;
    if (flag == "--help" && !has_value) {
      parsed_.help = true;
      return {};
    }
    const Field* field = find(flag);
    if (field != nullptr) {
      return has_value ? set(*field, flag, word.substr(equals + 1)) : set_bare(*field, flag);
    }
    // A settings file or a variable may switch an option on, so "--no-flag" must switch it off.
    field = flag.starts_with("--no-") ? find("--" + flag.substr(5)) : nullptr;
    if (field != nullptr && is_switch(*field) && !has_value) return set(*field, flag, "false");
    return unknown(flag);
  }

  // Parses flags of one letter, which may be joined: "-vo FILE".
  Result<void> letter(const std::string& word) {
    for (std::size_t i = 1; i < word.size(); ++i) {
      const std::string flag{'-', word[i]};
      const Field* field = find_letter(word[i]);
      if (word[i] == 'h') {
        parsed_.help = true;
        return {};
      }
      if (field == nullptr) return unknown(flag);
      if (!is_switch(*field) && i + 1 < word.size()) return set(*field, flag, word.substr(i + 1));
      KA_TRY(set_bare(*field, flag));
    }
    return {};
  }

  /// Sets the option of a flag without '='. If the flag needs a value, the next word is the value.
  Result<void> set_bare(const Field& field, const std::string& flag) {
    if (is_switch(field)) return set(field, flag, "true");
    if (at_ + 1 == words_.size() || looks_like_a_flag(words_[at_ + 1])) {
      return refuse(flag, "a value after it (" + placeholder(field) + ")",
                    at_ + 1 == words_.size() ? "nothing after it" : shown(words_[at_ + 1]));
    }
    return set(field, flag, words_[++at_]);
  }

  // Sets an option. The first value of a list replaces its default; other options may be given only
  // once.
  Result<void> set(const Field& field, const std::string& flag, const std::string& text) {
    const bool many = std::holds_alternative<std::vector<std::string>*>(field.value);
    // A flag that is given twice is mostly a mistake in a long command. Only flags of lists may be
    // repeated.
    const bool first = parsed_.given.insert_or_assign(field.name, Source::flag).second;
    if (!first && !many) return refuse(flag, "this flag once", "it twice");
    if (first && many) std::get<std::vector<std::string>*>(field.value)->clear();
    return set_field(field, text).map_error(in_file(flag));
  }

  // Gives the words to the verb's positionals. A positional that takes several words leaves enough
  // words for the positionals after it.
  Result<void> place_words() {
    std::size_t next = 0;
    std::size_t needed = 0;  // words that the positionals after this one need
    for (const Positional& place : usage_.positionals) needed += place.least;
    if (plain_.size() < needed)
      // With too few words, the first positionals get theirs and the last ones are reported as
      // missing.
      needed = 0;
    for (const Positional& place : usage_.positionals) {
      // `needed` counts only the positionals after this one.
      needed -= std::min(needed, place.least);
      for (std::size_t n = 0; n < place.most && next + needed < plain_.size(); ++n, ++next) {
        KA_TRY(place_word(place, plain_[next]));
      }
      if (place.words->size() < place.least) {
        return refuse("", place.name + " (" + place.meaning + ")", "nothing");
      }
    }
    if (next == plain_.size()) return {};
    const std::string& further = plain_[next];
    std::string advice;
    if (!usage_.positionals.empty()) {
      advice = usage_.positionals.back().if_more;
    } else if (further.ends_with(".toml")) {
      // People often give a lab file as a word, as they give a manifest; it belongs to --config.
      advice = "did you mean --config " + shown(further) + "?";
    }
    return refuse("", "no more words" + (advice.empty() ? "" : " (" + advice + ")"),
                  shown(further));
  }

  static Result<void> place_word(const Positional& place, const std::string& word) {
    const auto& choices = place.choices;
    if (!choices.empty() && std::find(choices.begin(), choices.end(), word) == choices.end()) {
      return refuse(place.name, any_of(choices), shown(word));
    }
    place.words->push_back(word);
    return {};
  }

  const Field* find(const std::string& flag) const {
    const auto found = std::find_if(fields_.begin(), fields_.end(), [&](const Field* field) {
      return flag_of(field->name) == flag;
    });
    return found == fields_.end() ? nullptr : *found;
  }

  const Field* find_letter(char letter) const {
    for (const auto& [short_name, name] : letters) {
      if (short_name == letter) return find(flag_of(name));
    }
    return nullptr;
  }

  Failure unknown(const std::string& flag) const {
    std::vector<std::string> known{"--help"};
    for (const Field* field : fields_) known.push_back(flag_of(field->name));
    const std::string near = suggestion(flag, known);
    return refuse("", "a known flag" + (near.empty() ? "" : " (" + near + ")"), shown(flag));
  }

  const std::vector<std::string>& words_;
  const Usage& usage_;
  std::vector<const Field*> fields_;
  std::size_t at_ = 0;
  std::vector<std::string> plain_;
  Parsed parsed_;
};

}  // namespace

Fields common_fields(Common& common, const Page& page) {
  const Field out_file{"out", "file to write", &common.out};
  const Field out_folder{.name = "out",
                         .meaning = page.out_is_new
                                        ? "new folder to write into; it must not exist yet"
                                        : "folder to write into; made if it does not exist",
                         .value = &common.out,
                         .stands_for = "FOLDER"};
  const Fields choosable{
      page.out_is_folder ? out_folder : out_file,
      {"force", "overwrite an existing file", &common.force},
      {"json", "print JSON and nothing else on stdout", &common.json},
      {"dry_run", "print what would be done, and write nothing", &common.dry_run},
      {"jobs", "threads to use; 0: one per processor", &common.jobs, 0.0, 1024.0},
  };
  Fields fields;
  for (const Field& field : choosable) {
    const auto& names = page.common;
    if (std::find(names.begin(), names.end(), field.name) != names.end()) fields.push_back(field);
  }
  // Every verb has the flags below.
  fields.push_back(
      {"config", "settings to use instead of the project's kinalign.toml", &common.config});
  fields.push_back({"quiet", "print errors only", &common.quiet});
  fields.push_back({"verbose", "print more: how each file was read, names of joints and nodes",
                    &common.verbose});
  fields.push_back(choice_flag("color", "colours; auto: on a terminal, unless NO_COLOR is set",
                               &common.color, {"auto", "always", "never"}));
  return fields;
}

bool is_common_setting(const std::string& name) {
  return name == "jobs" || name == "quiet" || name == "verbose" || name == "color";
}

Result<Parsed> parse_words(const std::vector<std::string>& words, const Usage& usage,
                           const Fields& common) {
  return Walk(words, usage, common).parse();
}

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = nearest_name(word, known);
  return near.empty() ? "" : "did you mean " + near + "?";
}

}  // namespace kinalign
