// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/host_node/node_run.h"

namespace kinalign {

/// One line of JSON: the counts by name, the light of sync, and the truth about the clock.
std::string report(const HostNodeOptions& options, NodeRun& node_run);

}  // namespace kinalign
