// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/advice.h"

#include <fmt/format.h>

namespace kinalign {

/// Only an error that a person can do something about gets advice.
std::vector<std::string> port_advice(const Error& error, const WantedPort& wanted) {
  // ss(8) of iproute2 lists open ports and the programs that opened them.
  if (error.kind == ErrorKind::port_taken) {
    return {fmt::format(
        "ss -{}lpn 'sport = :{}' shows which program uses it, perhaps another kinalign; {} "
        "sets another port",
        wanted.tcp ? 't' : 'u', wanted.port, wanted.port_from)};
  }
  // Linux allows ports below 1024 only with a special right. setcap gives the right to this program
  // alone, not to all programs of the user.
  if (error.kind == ErrorKind::port_forbidden) {
    return {
        "run as root, or allow it once: sudo setcap cap_net_bind_service=+ep $(command -v "
        "kinalign)",
        wanted.port_from +
            " sets a port from 1024 on, which needs no root rights, if all senders can use it"};
  }
  // The address that the user gave is not one of this machine's addresses.
  if (error.kind == ErrorKind::address_elsewhere) {
    return {"ip -brief address shows this machine's addresses; " + wanted.address_from +
            " accepts any of them"};
  }
  return {};
}

std::vector<std::string> key_advice(const Error& error) {
  switch (error.kind) {
    case ErrorKind::exposed_key:
      return {};
    case ErrorKind::forbidden_key:
      return {"run kinalign as the owner of the file, or change the owner (chown)"};
    case ErrorKind::no_such_file:
      return {
          "kinalign node-key --new-lab-key FILE makes the lab's key, if the lab has no key yet"};
    default:
      return {"--lab-key needs the lab's own key file, from which the nodes' keys were derived"};
  }
}

}  // namespace kinalign
