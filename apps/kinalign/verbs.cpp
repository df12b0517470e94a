// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/verbs.h"

namespace kinalign {

std::vector<Verb> all_verbs() { return {config_verb(), completion_verb(), man_verb()}; }

}  // namespace kinalign
