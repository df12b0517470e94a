// SPDX-License-Identifier: Apache-2.0
// A verb of the program, described once: its flags, settings, help page, completion and place in
// the man page all come from these structures. A verb is one file; CONTRIBUTING.md shows how.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/files.h"
#include "kinalign/core/options.h"

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace kinalign {

class Console;
struct Verb;
struct Common;

/// Where an option's value comes from; a later one wins.
enum class Source { standard, user, project, environment, flag };

/// By name of the option.
using Sources = std::map<std::string, Source>;

/// A command that works as it stands, and what it does.
struct Example {
  std::string command, meaning;
};

/// Words behind the verb that are no flags, in the order given.
struct Positional {
  std::string name;     // as the help page shows it: "FILE"
  std::string meaning;  // one line
  std::vector<std::string>* words;
  std::size_t least = 1, most = 1;
  std::vector<std::string> choices{};  // empty: any text
  std::string if_more{};               // what to do where more than `most` are given
};

/// What a verb takes. The pointers lead into the verb's own options.
struct Usage {
  std::vector<Positional> positionals;
  Fields flags;     // on the command line only; a vector of strings may be given as often as wanted
  Fields settings;  // also from KINALIGN_<NAME> and from the verb's table in kinalign.toml
  /// What the parts can't say; its failures are wrong use. `given`: what was said, and where.
  std::function<Result<void>(const Common& common, const Sources& given)> check;
};

/// The flags that mean the same everywhere. A verb names those it takes (Page::common); config,
/// quiet, verbose and color are always there.
struct Common {
  std::string out;
  bool force = false;
  bool json = false;
  bool dry_run = false;
  std::int64_t jobs = 0;  // as given: 0 is the number of processors; Call::jobs is never 0
  std::string config;
  bool quiet = false, verbose = false;
  std::string color = "auto";

  Overwrite overwrite() const { return force ? Overwrite::yes : Overwrite::no; }
};

/// The machine as the program finds it: a test makes its own.
struct Surroundings {
  std::function<std::string(const std::string&)> variable;  // of the environment; empty: not set
  std::string folder;                                       // the current one, absolute
  int out = 1, err = 2;
  bool out_is_terminal = false, err_is_terminal = false;
  FileSystem& files;
};

/// All that a verb gets beside its own options.
struct Call {
  const Common& common;
  const Sources& sources;  // of the verb's settings and flags that were given somewhere
  std::size_t jobs;        // threads to use, at least 1
  Console& console;
  const std::vector<Verb>& verbs;
  const Surroundings& surroundings;
};

/// A verb as people see it.
struct Page {
  std::string name;                 // "align"; of a group of verbs "dataset build"
  std::string summary;              // one line, for the list of verbs
  std::string text;                 // what more there is to know; may be empty
  std::vector<Example> examples;    // the first one opens the help page
  std::vector<std::string> common;  // of out, force, json, dry_run, jobs: those it takes
  bool out_is_folder = false;
  bool out_is_new = false;  // of a folder: none may be there
};

struct Verb {
  Page page;
  /// Makes the verb's options, lets `fill` set them, and where that says so runs with them. The
  /// int is the exit code: 0 done, 1 findings.
  std::function<Result<int>(const std::function<bool(Usage&)>& fill,
                            const std::function<Call()>& call)>
      enter;
};

/// A verb from its options' structure, the description of it and the function that does the job.
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

/// "dataset" of "dataset build"; empty for a verb of its own.
std::string group_of(const std::string& verb_name);

/// The groups of verbs, in the order of their first verbs.
std::vector<std::string> groups_of(const std::vector<Verb>& verbs);

/// The description of a verb's options with their standard values, while `use` looks at it.
void describe_verb(const Verb& verb, const std::function<void(const Usage&)>& use);

/// Sets in `onto` what `from` says, for those options whose source is `least` or later: how flags
/// win over a manifest that was read in the meantime.
void copy_given(const Fields& from, const Fields& onto, const Sources& sources, Source least);

}  // namespace kinalign
