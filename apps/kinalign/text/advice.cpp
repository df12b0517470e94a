// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/advice.h"

#include <fmt/format.h>

namespace kinalign {

/// Only errors that a person can act on get advice.
std::vector<std::string> port_advice(const Error& error, const WantedPort& wanted) {
  if (error.kind == ErrorKind::port_taken) {
    return {
        fmt::format("ss -{}lpn 'sport = :{}' shows which one, another kinalign perhaps; {} takes "
                    "another port",
                    wanted.tcp ? 't' : 'u', wanted.port, wanted.port_from)};
  }
  if (error.kind == ErrorKind::port_forbidden) {
    return {"as root, or once: sudo setcap cap_net_bind_service=+ep $(command -v kinalign)",
            wanted.port_from +
                " takes a port from 1024 on, which needs no rights, for who can be told one"};
  }
  if (error.kind == ErrorKind::address_elsewhere) {
    return {"ip -brief address shows this machine's; " + wanted.address_from +
            " takes one of them"};
  }
  return {};
}

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
