// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/port_advice.h"

#include <fmt/format.h>

namespace kinalign {

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

}  // namespace kinalign
