// SPDX-License-Identifier: Apache-2.0
// The advice depends on the kind of an error, never on its words.
#include "apps/kinalign/text/advice.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

using Lines = std::vector<std::string>;

Error of(ErrorKind kind) { return {"lab.key", 0, "any words", "others", kind}; }

}  // namespace

TEST_CASE("a key that can't be read has advice by what stands in the way") {
  // No advice: the error itself says chmod 600.
  CHECK(key_advice(of(ErrorKind::exposed_key)).empty());
  CHECK(key_advice(of(ErrorKind::forbidden_key)) ==
        Lines{"run kinalign as the owner of the file, or change the owner (chown)"});
  CHECK(
      key_advice(of(ErrorKind::no_such_file)) ==
      Lines{"kinalign node-key --new-lab-key FILE makes the lab's key, if the lab has no key yet"});
  CHECK(key_advice(of(ErrorKind::other)) ==
        Lines{"--lab-key needs the lab's own key file, from which the nodes' keys were derived"});
}

TEST_CASE("a port that can't be opened has advice by what stands in the way") {
  const WantedPort udp{123, "--port", "--listen", false}, tcp{7001, "--port", "--listen", true};
  CHECK(port_advice(of(ErrorKind::port_taken), udp) ==
        Lines{"ss -ulpn 'sport = :123' shows which program uses it, perhaps another kinalign; "
              "--port sets another port"});
  CHECK(port_advice(of(ErrorKind::port_taken), tcp).front().starts_with("ss -tlpn"));
  CHECK(port_advice(of(ErrorKind::port_forbidden), udp) ==
        Lines{"run as root, or allow it once: sudo setcap cap_net_bind_service=+ep $(command -v "
              "kinalign)",
              "--port sets a port from 1024 on, which needs no root rights, if all senders can use "
              "it"});
  CHECK(port_advice(of(ErrorKind::address_elsewhere), udp) ==
        Lines{"ip -brief address shows this machine's addresses; --listen accepts any of them"});
  CHECK(port_advice(of(ErrorKind::other), udp).empty());
}
