// SPDX-License-Identifier: Apache-2.0
// All verbs, in the order of the help page. A new verb: its file, a line here, a line in verbs.cpp.
#pragma once

#include "apps/cli/verb.h"

#include <vector>

namespace kinalign {

Verb align_verb();
Verb info_verb();
Verb check_verb();
Verb report_verb();
Verb convert_verb();
Verb rebuild_verb();
Verb record_verb();
Verb recover_verb();
Verb simulate_verb();
Verb time_server_verb();
Verb node_key_verb();
Verb config_verb();
Verb completion_verb();
Verb man_verb();

std::vector<Verb> all_verbs();

}  // namespace kinalign
