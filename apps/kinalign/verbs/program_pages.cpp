// SPDX-License-Identifier: Apache-2.0
// The verbs `completion` and `man`, which print a page about the program itself.
#include "apps/cli/console.h"
#include "apps/cli/help.h"
#include "apps/kinalign/verbs.h"

namespace kinalign {

namespace {

/// The options of `kinalign completion`: one word, the shell. The usage lists the allowed words, so
/// that they are completed, too.
struct Completion {
  std::vector<std::string> shell;
};

Usage describe_completion(Completion& o) {
  Usage usage;
  usage.positionals = {{"SHELL", "name of the shell", &o.shell, 1, 1, {"bash", "zsh", "fish"}}};
  return usage;
}

Result<int> run_completion(Completion& o, Call& call) {
  // The script contains all verbs and flags, so it does not call kinalign when it runs.
  call.console.put(completion_script(o.shell.front(), call.verbs));
  return 0;
}

/// The options of `kinalign man`, which has none. The man page is made from the same descriptions
/// as --help, so both always agree.
struct Man {};

Usage describe_man(Man&) { return {}; }

Result<int> run_man(Man&, Call& call) {
  // The page is the result, so put() prints it even with --quiet.
  call.console.put(man_page(call.verbs));
  return 0;
}

}  // namespace

/// The verb `kinalign completion`.
Verb completion_verb() {
  return make_verb<Completion>(
      {.name = "completion",
       .summary = "print a script that completes verbs and flags in a shell",
       .text = "",
       .examples =
           {{"kinalign completion bash > ~/.local/share/bash-completion/completions/kinalign",
             "for new shells of bash"},
            {"kinalign completion zsh > ~/.zfunc/_kinalign",
             "for new shells of zsh, if ~/.zfunc is a folder of its fpath"},
            {"kinalign completion fish > ~/.config/fish/completions/kinalign.fish",
             "for new shells of fish"}},
       .common = {}},
      describe_completion, run_completion);
}

Verb man_verb() {
  return make_verb<Man>({.name = "man",
                         .summary = "print the man page",
                         .text = "",
                         .examples = {{"kinalign man | man -l -", "shows the page"}},
                         .common = {}},
                        describe_man, run_man);
}

}  // namespace kinalign
