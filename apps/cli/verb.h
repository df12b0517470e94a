// SPDX-License-Identifier: Apache-2.0
// A verb of the program, described once: its flags, settings, help page, completion and section of
// the man page all come from these structures. A verb is one file; CONTRIBUTING.md shows how to add
// one.
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

/// The source of an option's value; a later one wins.
enum class Source { standard, user, project, environment, flag };

/// The sources of options, by the option's name.
using Sources = std::map<std::string, Source>;

/// A command that works as written, and its meaning.
struct Example {
  std::string command, meaning;
};

/// Words after the verb that are not flags, in the order given.
/// A positional that takes several words leaves enough of them for those after it (parse_words()).
struct Positional {
  std::string name;     // in the help page: "FILE"
  std::string meaning;  // one line
  std::vector<std::string>* words;
  std::size_t least = 1, most = 1;
  std::vector<std::string> choices{};  // empty: any text
  std::string if_more{};               // advice if more than `most` are given
};

/// The options of a verb. The pointers lead into the verb's own options.
struct Usage {
  std::vector<Positional> positionals;
  Fields flags;     // only on the command line; a vector of strings may be given repeatedly
  Fields settings;  // also from KINALIGN_<NAME> and the verb's table in kinalign.toml
  /// Checks that single fields can't express; a failure is wrong use. `given`: the options that
  /// were set, and their sources.
  std::function<Result<void>(const Common& common, const Sources& given)> check;
};

/// The flags that mean the same for every verb. A verb names those that it takes (Page::common);
/// config, quiet, verbose and color always exist.
struct Common {
  std::string out;
  bool force = false;
  bool json = false;
  bool dry_run = false;
  std::int64_t jobs = 0;  // 0: one for each processor; Call::jobs is never 0
  std::string config;
  bool quiet = false, verbose = false;
  std::string color = "auto";

  Overwrite overwrite() const { return force ? Overwrite::yes : Overwrite::no; }
};

/// The system around the program. A test makes its own.
struct Surroundings {
  std::function<std::string(const std::string&)> variable;  // environment; empty: not set
  std::string folder;                                       // the current folder, absolute
  int out = 1, err = 2;
  bool out_is_terminal = false, err_is_terminal = false;
  FileSystem& files;
};

/// Fails unless --out ends in one of these; without `endings`, unless it is given. `expected`: "-o
/// FILE.bvh".
Result<void> check_out(const Common& common, std::initializer_list<std::string_view> endings,
                       std::string expected);

/// A flag whose value has a word of its own in --help: "FOLDER".
Field text_flag(std::string name, std::string meaning, decltype(Field::value) value,
                std::string stands_for);
/// A flag that accepts only these texts.
Field choice_flag(std::string name, std::string meaning, decltype(Field::value) value,
                  std::vector<std::string> choices);

/// Everything that a verb gets besides its own options.
struct Call {
  const Common& common;
  const Sources& sources;  // only options that were set anywhere
  std::size_t jobs;        // threads to use, at least 1
  Console& console;
  const std::vector<Verb>& verbs;
  const Surroundings& surroundings;
};

/// A verb as its help page shows it.
/// Help page, man page and completions are made from it; nothing else states a verb's flags.
struct Page {
  std::string name;                 // "align"; in a group of verbs "dataset build"
  std::string summary;              // one line, for the list of verbs
  std::string text;                 // the rest of the page's text; may be empty
  std::vector<Example> examples;    // the first one opens the help page
  std::vector<std::string> common;  // the verb takes these of out, force, json, dry_run, jobs
  bool out_is_folder = false;
  bool out_is_new = false;  // the folder must not exist yet
};

/// `enter` hides the type of the options, so that verbs of different options are in one list.
struct Verb {
  Page page;
  /// Makes the verb's options and lets `fill` set them; if `fill` returns true, runs the verb with
  /// them. The int is the exit code: 0 done, 1 findings.
  std::function<Result<int>(const std::function<bool(Usage&)>& fill,
                            const std::function<Call()>& call)>
      enter;
};

/// Makes a verb from the structure of its options, their description and the function that does the
/// job.
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

/// The groups of verbs, in the order of their first verbs.
std::vector<std::string> groups_of(const std::vector<Verb>& verbs);

/// The second words of a group's verbs: "build" of "dataset build".
std::vector<std::string> names_in(const std::string& group, const std::vector<Verb>& verbs);

/// Calls `use` with the description of a verb's options, which have their defaults.
void describe_verb(const Verb& verb, const std::function<void(const Usage&)>& use);

/// Copies from `from` to `onto` those options whose source is `least` or stronger. With it, flags
/// win over a manifest that was read later.
void copy_given(const Fields& from, const Fields& onto, const Sources& sources, Source least);

}  // namespace kinalign
