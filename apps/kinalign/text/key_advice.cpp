// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/key_advice.h"

#include "kinalign/capture/nodes/node_keys.h"

#include <cerrno>
#include <cstring>

namespace kinalign {

std::vector<std::string> key_advice(const Error& error) {
  if (error.expected == secret_key) return {};
  if (error.found.starts_with(no_permission)) {
    return {"run it as the file's owner, or let who runs it own the file (chown)"};
  }
  if (error.found == std::strerror(ENOENT)) {
    return {"kinalign node-key --new-lab-key FILE makes one, where the lab has none yet"};
  }
  return {"--lab-key takes the lab's own file, from which the nodes' keys came"};
}

}  // namespace kinalign
