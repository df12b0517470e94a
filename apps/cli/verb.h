// SPDX-License-Identifier: Apache-2.0
// The description of a verb of the program. The verb's flags, settings, help page, completion and
// section of the man page all come from it. Each verb has one file; CONTRIBUTING.md shows how to
// add a verb.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/files.h"
#include "kinalign/core/options.h"

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

class Console;
struct Verb;
struct Common;

/// The source of an option's value, from weak to strong. A stronger source overrides a weaker one.
enum class Source { standard, user, project, environment, flag };

/// The source of each option that was set, by the option's name.
using Sources = std::map<std::string, Source>;

/// A command that works as it is written, and what it does.
struct Example {
  std::string command, meaning;
};

/// Words after the verb that are not flags, in the order in which they are given. If a positional
/// takes several words, enough are left for the positionals after it (parse_words()).
struct Positional {
  std::string name;     // in the help page: "FILE"
  std::string meaning;  // one line
  std::vector<std::string>* words;
  std::size_t least = 1, most = 1;
  std::vector<std::string> choices{};  // empty: any text
  std::string if_more{};               // advice if more than `most` words are given
};

/// The description of a verb's options. Its pointers lead to the values of the options.
struct Usage {
  std::vector<Positional> positionals;
  Fields flags;     // on the command line only; a flag of a vector of strings may be repeated
  Fields settings;  // also in KINALIGN_<NAME> and in the verb's table in kinalign.toml
  /// Checks that concern several options together; a failure is wrong use. `given`: the options
  /// that were set, and their sources.
  std::function<Result<void>(const Common& common, const Sources& given)> check;
};

/// The flags that mean the same for every verb. Page::common names those that a verb takes. Every
/// verb takes config, quiet, verbose and color.
struct Common {
  std::string out;
  bool force = false;
  bool json = false;
  bool dry_run = false;
  std::int64_t jobs = 0;  // 0: as many threads as processors; Call::jobs is never 0
  std::string config;
  bool quiet = false, verbose = false;
  std::string color = "auto";

  Overwrite overwrite() const { return force ? Overwrite::yes : Overwrite::no; }
};

/// The parts of the operating system that the program uses. A test gives its own parts.
struct Surroundings {
  // Returns the value of an environment variable. Empty if the variable is not set.
  std::function<std::string(const std::string&)> variable;
  std::string folder;  // the current folder, absolute
  int out = 1, err = 2;
  bool out_is_terminal = false, err_is_terminal = false;
  FileSystem& files;
};

/// Fails unless the name given with --out ends in one of `endings`. Without `endings` any name is
/// accepted, but there must be one. `expected` is for the message: "-o FILE.bvh".
Result<void> check_out(const Common& common, std::initializer_list<std::string_view> endings,
                       std::string expected);

/// A flag whose value has its own word in the help page: "FOLDER".
Field text_flag(std::string name, std::string meaning, decltype(Field::value) value,
                std::string stands_for);
/// A flag that accepts only these texts.
Field choice_flag(std::string name, std::string meaning, decltype(Field::value) value,
                  std::vector<std::string> choices);

/// Everything that a verb gets besides its own options, for one run.
struct Call {
  const Common& common;
  const Sources& sources;  // only options that were set anywhere
  std::size_t jobs;        // threads to use, at least 1
  Console& console;
  const std::vector<Verb>& verbs;
  const Surroundings& surroundings;
};

/// A verb as its help page shows it. The help page, the man page and the completions are all made
/// from this structure.
struct Page {
  std::string name;               // "align"; with a group: "dataset build"
  std::string summary;            // one line, for the list of verbs
  std::string text;               // the rest of the page's text; may be empty
  std::vector<Example> examples;  // the first one opens the help page
  // The flags among out, force, json, dry_run and jobs that the verb takes.
  std::vector<std::string> common;
  bool out_is_folder = false;
  bool out_is_new = false;  // the folder must not exist yet
};

/// A verb. `enter` hides the type of the verb's options, so that one list can have all verbs.
struct Verb {
  Page page;
  /// Makes the verb's options and lets `fill` set them. If `fill` returns true, the verb is run
  /// with these options. The int is the exit code: 0 done, 1 findings.
  std::function<Result<int>(const std::function<bool(Usage&)>& fill,
                            const std::function<Call()>& call)>
      enter;
};

/// Makes a verb from three parts: the structure of its options, the function that describes them
/// and the function that does the job.
template <class Options>
Verb make_verb(Page page, Usage (*describe)(Options&), Result<int> (*run)(Options&, Call&)) {
  return {std::move(page),
          [describe, run](const std::function<bool(Usage&)>& fill,
                          const std::function<Call()>& call) -> Result<int> {
            Options options;
            Usage usage = describe(options);
            if (!fill(usage)) return 0;
            Call made = call();
            return run(options, made);
          }};
}

/// The group of a verb: "dataset" for "dataset build"; empty for a verb without group.
std::string group_of(const std::string& verb_name);

/// The groups of verbs, in the order in which they first appear in the list of verbs.
std::vector<std::string> groups_of(const std::vector<Verb>& verbs);

/// The second words of a group's verbs: "build" of "dataset build".
std::vector<std::string> names_in(const std::string& group, const std::vector<Verb>& verbs);

/// Calls `use` with the description of a verb's options. The options have their defaults.
void describe_verb(const Verb& verb, const std::function<void(const Usage&)>& use);

/// Copies those options from `from` to `onto` whose source is `least` or stronger. A verb calls it
/// after it has read a manifest, so that flags override the manifest.
void copy_given(const Fields& from, const Fields& onto, const Sources& sources, Source least);

}  // namespace kinalign
