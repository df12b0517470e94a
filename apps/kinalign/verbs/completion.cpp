// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/cli/help.h"
#include "apps/kinalign/verbs.h"

namespace kinalign {

namespace {

/// One word: the shell. Its legal values stand in the usage, so they are completed too.
struct Completion {
  std::vector<std::string> shell;
};

Usage describe(Completion& o) {
  Usage usage;
  usage.positionals = {{"SHELL", "name of the shell", &o.shell, 1, 1, {"bash", "zsh", "fish"}}};
  return usage;
}

Result<int> run(Completion& o, Call& call) {
  // The script is complete: it lists all verbs and flags and does not call kinalign when it runs.
  call.console.put(completion_script(o.shell.front(), call.verbs));
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
      describe, run);
}

}  // namespace kinalign
