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
        Lines{"run it as the file's owner, or let who runs it own the file (chown)"});
  CHECK(key_advice(of(ErrorKind::no_such_file)) ==
        Lines{"kinalign node-key --new-lab-key FILE makes one, where the lab has none yet"});
  CHECK(key_advice(of(ErrorKind::other)) ==
        Lines{"--lab-key takes the lab's own file, from which the nodes' keys came"});
}

TEST_CASE("a port that can't be opened has advice by what stands in the way") {
  const WantedPort udp{123, "--port", "--listen", false}, tcp{7001, "--port", "--listen", true};
  CHECK(port_advice(of(ErrorKind::port_taken), udp) ==
        Lines{"ss -ulpn 'sport = :123' shows which one, another kinalign perhaps; --port takes "
              "another port"});
  CHECK(port_advice(of(ErrorKind::port_taken), tcp).front().starts_with("ss -tlpn"));
  CHECK(port_advice(of(ErrorKind::port_forbidden), udp) ==
        Lines{"as root, or once: sudo setcap cap_net_bind_service=+ep $(command -v kinalign)",
              "--port takes a port from 1024 on, which needs no rights, for who can be told one"});
  CHECK(port_advice(of(ErrorKind::address_elsewhere), udp) ==
        Lines{"ip -brief address shows this machine's; --listen takes one of them"});
  CHECK(port_advice(of(ErrorKind::other), udp).empty());
}
