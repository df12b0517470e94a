// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/key_advice.h"

namespace kinalign {

std::vector<std::string> key_advice(const Error& error) {
  switch (error.kind) {
    case ErrorKind::exposed_key:
      return {};
    case ErrorKind::forbidden_key:
      return {"run it as the file's owner, or let who runs it own the file (chown)"};
    case ErrorKind::no_such_file:
      return {"kinalign node-key --new-lab-key FILE makes one, where the lab has none yet"};
    default:
      return {"--lab-key takes the lab's own file, from which the nodes' keys came"};
  }
}

}  // namespace kinalign
