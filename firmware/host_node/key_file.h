// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/host_node/trouble.h"

#include "kinalign/wire/node_datagram.h"

namespace kinalign {

/// A node's own key: 32 hexadecimal digits, in a file that nobody else may read.
Tried<MacKey> read_key_file(const std::string& path);

}  // namespace kinalign
