// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/program.h"

#include "apps/cli/command_line.h"
#include "apps/cli/console.h"
#include "apps/cli/file_advice.h"
#include "apps/cli/help.h"
#include "apps/cli/settings.h"

#include <algorithm>
#include <new>
#include <optional>
#include <thread>

namespace kinalign {

namespace {

/// Turns a failed allocation (bad_alloc) into an error: a damaged file of a few bytes may ask for
/// gigabytes.
template <class Work>
Result<int> with_memory(const Work& work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return Failure(Error{"", 0, "enough memory for the files", "no free memory"});
  }
}

/// Runs one verb once: sets its options, runs it and returns the exit code. The verb calls back
/// twice: take_words() sets the options, then enter() opens the console. Call holds references to
/// the members below, so they live as long as the verb runs.
class Run {
 public:
  Run(const Verb& verb, const std::vector<Verb>& verbs, std::vector<std::string> words,
      const Surroundings& surroundings)
      : verb_(verb), verbs_(verbs), words_(std::move(words)), surroundings_(surroundings) {}

  int operator()() {
    const auto fill = [&](Usage& usage) { return take_words(usage); };
    const auto call = [&] { return enter(); };
    // If the options could not be set or only a help page was printed, the exit code is early_.
    const Result<int> code = with_memory([&] { return verb_.enter(fill, call); });
    if (!filled_) return early_;
    return leave(code);
  }

 private:
  /// Sets the options. Returns true if the verb shall run; otherwise early_ is the exit code.
  bool take_words(Usage& usage) {
    const Result<bool> help = set_options(usage);
    // The verb's console is opened later, when all options are known, so errors here need another
    // console.
    Console console(surroundings_, common_, verb_.page.name);
    if (!help) {
      console.if_it_fails([&](const Error& error) { return advice(error); });
      console.report(help.error());
      early_ = unreadable_ ? failed : wrong_use;
    } else if (*help) {
      console.put(help_page(verb_.page, usage));
      early_ = console.finish() ? done : failed;
    } else {
      filled_ = true;
    }
    return filled_;
  }

  // The advice for an error that occurs before the verb runs.
  std::vector<std::string> advice(const Error& error) const {
    const std::string variable = surroundings_.variable("KINALIGN_CONFIG");
    // The advice names the variable KINALIGN_CONFIG, because the user may have forgotten that it is
    // set.
    const bool by_variable = common_.config.empty() && error.file == variable;
    if (unreadable_ && by_variable) return {"the variable KINALIGN_CONFIG names this file"};
    if (unreadable_) return {};
    if (error.line > 0) return {std::string(settings_pages)};
    return {"kinalign " + verb_.page.name + " --help lists its arguments and flags, with examples"};
  }

  Result<std::vector<SettingsFile>> read_settings() {
    const auto found = find_settings(surroundings_, common_.config);
    unreadable_ = !found;
    return parse_settings(KA_TRY(found));
  }

  /// Sets the options from flags, settings files and environment variables. A source never
  /// overrides a stronger one. Returns true if the user asked for the help page.
  Result<bool> set_options(Usage& usage) {
    const Fields common = common_fields(common_, verb_.page);
    // Flags are read first, because --config names a settings file. apply_settings() does not
    // override flags.
    Parsed parsed = KA_TRY(parse_words(words_, usage, common));
    // Other flags, such as --quiet, must not suppress the help page.
    if (parsed.help) {
      common_ = Common{};
      return true;
    }
    sources_ = std::move(parsed.given);
    const Settable settable{verb_.page, usage.settings, common};
    for (const SettingsFile& file : KA_TRY(read_settings())) {
      KA_TRY(apply_settings(file, settable, verbs_, sources_));
    }
    KA_TRY(apply_environment(surroundings_, settable, sources_));
    if (usage.check) KA_TRY(usage.check(common_, sources_));
    return false;
  }

  Call enter() {
    // Signals are taken only from here on: while the options are set, Ctrl-C may end the program at
    // once.
    take_signals();
    console_.emplace(surroundings_, common_, verb_.page.name);
    // hardware_concurrency() returns 0 if the number of processors is not known.
    const auto processors = std::max(1U, std::thread::hardware_concurrency());
    const auto jobs = common_.jobs > 0 ? static_cast<std::size_t>(common_.jobs) : processors;
    return Call{common_, sources_, jobs, *console_, verbs_, surroundings_};
  }

  // The exit code after the verb has run. Text that stdout refused counts as a failure.
  int leave(const Result<int>& code) {
    // If Ctrl-C stopped the verb, the verb's own error is not printed. A verb that succeeded in
    // spite of Ctrl-C keeps its exit code.
    if (interrupted() && !code) {
      console_->complain("kinalign " + verb_.page.name + ": stopped; no unfinished file is left");
      return stopped;
    }
    if (!code) {
      console_->report(code.error());
      for (const std::string& line : file_advice(code.error())) console_->complain("  " + line);
    }
    const Result<void> written = console_->finish();
    if (!written) console_->report(written.error());
    if (!code && console_->refused()) return wrong_use;
    return code && written ? *code : failed;
  }

  const Verb& verb_;
  const std::vector<Verb>& verbs_;
  std::vector<std::string> words_;
  const Surroundings& surroundings_;
  Common common_;
  Sources sources_;
  std::optional<Console> console_;
  bool filled_ = false;
  bool unreadable_ = false;  // a settings file can't be read
  int early_ = done;
};

/// Prints `text` on stdout, or on stderr if the command was wrong.
int say(const std::string& text, ExitCode code, const Surroundings& surroundings) {
  const Common common;
  Console console(surroundings, common, "");
  if (code == done) {
    console.put(text);
    return console.finish() ? done : failed;
  }
  // note() adds a line end, so the text's own line ends are removed.
  console.note(text.substr(0, text.find_last_not_of('\n') + 1));
  return code;
}

/// Reports a word that is no verb, and suggests the most similar verb.
int unknown_verb(const std::vector<Verb>& verbs, const std::string& word,
                 const Surroundings& surroundings) {
  // Besides verbs, these words may also stand first.
  std::vector<std::string> known{"--help", "--version", "help"};
  for (const Verb& verb : verbs) known.push_back(verb.page.name);
  const Common common;
  Console console(surroundings, common, "");
  console.if_it_fails([&](const Error&) {
    const std::string near = suggestion(word, known);
    return std::vector<std::string>{(near.empty() ? "" : near + " ") +
                                    "kinalign --help lists the verbs"};
  });
  const bool flag = word.starts_with('-');
  console.report(Error{"", 0, flag ? "a verb before its flags" : "a known verb", shown(word)});
  return wrong_use;
}

/// Joins the two words of a verb in a group: "dataset", "build" gives "dataset build".
void join_group(const std::vector<Verb>& verbs, std::vector<std::string>& words) {
  if (words.size() < 2) return;
  const std::vector<std::string> groups = groups_of(verbs);
  const bool is_group = std::find(groups.begin(), groups.end(), words.front()) != groups.end();
  const bool is_flag = words[1].starts_with('-');
  if (!is_group || is_flag) return;
  words.front() += " " + words[1];
  words.erase(words.begin() + 1);
}

}  // namespace

int run_program(const std::vector<Verb>& verbs, const std::vector<std::string>& given,
                const Surroundings& surroundings) {
  std::vector<std::string> words = given;
  // A command without words is wrong use, so the overview goes to stderr.
  if (words.empty()) return say(overview(verbs), wrong_use, surroundings);
  if (words.front() == "--version") {
    return say("kinalign " + program_version() + "\n", done, surroundings);
  }
  const auto is_help = [](const std::string& word) { return word == "--help" || word == "-h"; };
  const bool help = is_help(words.front()) || words.front() == "help";
  if (help && words.size() == 1) return say(overview(verbs), done, surroundings);
  if (help) words.erase(words.begin());
  join_group(verbs, words);
  const std::string name = words.front();
  std::vector<std::string> rest(words.begin() + 1, words.end());
  // `kinalign help align` is the same as `kinalign align --help`.
  if (help) rest = {"--help"};
  const std::vector<std::string> groups = groups_of(verbs);
  if (std::find(groups.begin(), groups.end(), name) != groups.end()) {
    const bool asked = !rest.empty() && is_help(rest.front());
    return say(group_page(name, verbs), asked ? done : wrong_use, surroundings);
  }
  const auto verb = std::find_if(verbs.begin(), verbs.end(),
                                 [&](const Verb& one) { return one.page.name == name; });
  if (verb == verbs.end()) return unknown_verb(verbs, name, surroundings);
  return Run(*verb, verbs, std::move(rest), surroundings)();
}

}  // namespace kinalign
