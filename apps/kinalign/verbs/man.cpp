// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/cli/help.h"
#include "apps/kinalign/verbs.h"

namespace kinalign {

namespace {

/// `man` has no options. The page is made from the same descriptions as --help, so both always
/// agree.
struct Man {};

Usage describe(Man&) { return {}; }

Result<int> run(Man&, Call& call) {
  // put() ignores --quiet: the page is the result itself.
  call.console.put(man_page(call.verbs));
  return 0;
}

}  // namespace

Verb man_verb() {
  return make_verb<Man>({.name = "man",
                         .summary = "print the man page",
                         .text = "",
                         .examples = {{"kinalign man | man -l -", "shows the page"}},
                         .common = {}},
                        describe, run);
}

}  // namespace kinalign
