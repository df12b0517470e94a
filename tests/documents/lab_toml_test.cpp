// SPDX-License-Identifier: Apache-2.0
#include "kinalign/documents/lab_toml.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <string>

using namespace kinalign;

namespace {

std::string error_of(const std::string& toml) {
  const auto devices = read_devices(toml, "labs/lab.toml");
  return devices ? "none" : to_string(devices.error());
}

const std::string mocap = "[device.mocap]\nprotocol = \"noitom\"\nport = 7012\n";

}  // namespace

TEST_CASE("a lab says of each device what it speaks, where it is heard and what is known of it") {
  const auto devices = read_devices(R"([record]
pre_roll_s = 3
[device.mocap]
protocol = "noitom"
transport = "tcp"
address = "192.168.7.5"
port = 7001
skeleton = "rig.bvh"
rate_hz = 125
[device.imu]
protocol = "nodes"
port = 5005
lab_key = "/keys/lab.key"
required = false
nodes = { "12" = "RightForeArm", "7" = "Hips" }
)",
                                    "labs/lab.toml");
  REQUIRE_MESSAGE(devices, (devices ? "" : to_string(devices.error())));
  REQUIRE(devices->size() == 2);
  const DeviceOptions& first = devices->front();
  CHECK(first.name == "mocap");
  CHECK(first.protocol == "noitom");
  CHECK(first.transport == "tcp");
  CHECK(first.address == "192.168.7.5");
  CHECK(first.port == 7001);
  CHECK(first.skeleton == "labs/rig.bvh");  // in the folder of lab.toml
  CHECK(first.rate_hz == 125);
  CHECK(first.required);
  const DeviceOptions& second = devices->back();
  CHECK(second.transport == "udp");
  CHECK(second.lab_key == "/keys/lab.key");
  CHECK(!second.required);
  CHECK(second.nodes == std::map<std::string, std::string>{{"12", "RightForeArm"}, {"7", "Hips"}});
}

TEST_CASE("a file without devices is a lab without any") {
  CHECK(read_devices("[align]\ngap_ms = 3\n", "kinalign.toml")->empty());
}

TEST_CASE("a key of many parts is refused before every part is copied with its path") {
  std::string deep = "a";
  for (int part = 0; part < 2'000; ++part) deep += ".a";
  const std::string refused =
      "labs/lab.toml:1: expected keys of at most 250 bytes with their tables, found a longer key";
  CHECK(error_of(deep + " = 1\n") == refused);
  CHECK(error_of("[" + deep + "]\n") == refused);
  CHECK(error_of(std::string(251, 'k') + " = [1, 2]\n") == refused);
}

TEST_CASE("a key of 60,000 parts is refused and does not use up the stack") {
  std::string deep = "a";
  for (int part = 1; part < 60'000; ++part) deep += ".a";
  const std::string refused =
      "expected keys of at most 250 bytes with their tables, found a longer key";
  CHECK(error_of(deep + " = 1\n") == "labs/lab.toml:1: " + refused);
  CHECK(error_of("\n[" + deep + "]\n") == "labs/lab.toml:2: " + refused);
  CHECK(error_of("a = { " + deep + " = 1 }\n") == "labs/lab.toml:1: " + refused);
}

TEST_CASE("dots in a text are no parts of a key") {
  CHECK(read_devices("[align]\n# " + std::string(200, '.') + "\ngap_ms = 3\n", "kinalign.toml"));
}

TEST_CASE("what is wrong with a device is told with its line and the nearest known name") {
  CHECK(error_of(mocap + "prot = 1\n") ==
        "labs/lab.toml:4: expected a key of [device.mocap] (nearest: port), found \"prot\"");
  CHECK(error_of("[device.a]\nprotocol = \"node\"\n") ==
        "labs/lab.toml:2: expected protocol as one of nodes, noitom, xsens, kinect, slimevr, found "
        "\"node\"");
  CHECK(error_of("[device.a]\nport = 1\n") == "labs/lab.toml:1: expected a protocol, found none");
  CHECK(error_of("[device.a]\nprotocol = \"nodes\"\nport = 70000\n") ==
        "labs/lab.toml:3: expected port as a whole number from 0 to 65535, found 70000");
  CHECK(error_of(mocap + "[device.b]\nprotocol = \"xsens\"\nport = 7012\n") ==
        "labs/lab.toml:4: expected a port of its own, found 7012, as mocap");
  CHECK(error_of("[device.a]\nprotocol = \"nodes\"\n") ==
        "labs/lab.toml:1: expected port to receive on (0: any free port), found no port");
  CHECK(error_of("[device.a]\nprotocol = \"nodes\"\nport = 1\n[device.b]\nprotocol = "
                 "\"nodes\"\nport = 2\n") ==
        "labs/lab.toml:4: expected one device for all nodes, found a second one, a");
  CHECK(error_of(mocap + "nodes = { \"1\" = \"Hips\" }\n") ==
        "labs/lab.toml:1: expected nodes only for protocol nodes, found protocol noitom");
  CHECK(error_of("[device.a]\nprotocol = \"nodes\"\nnodes = { waist = \"Hips\" }\n") ==
        "labs/lab.toml:1: expected a node's id, a whole number, as each key of nodes, found waist");
  const std::string nodes = "[device.a]\nprotocol = \"nodes\"\nport = 1\nnodes = ";
  CHECK(error_of(nodes + "{ \"1\" = \"Hips\", \"2\" = \"Hips\" }\n") ==
        "labs/lab.toml:1: expected a place of its own for each node, found Hips of nodes 1 and 2");
  CHECK(error_of(nodes + "{ \"1\" = \"2\", \"2\" = \"Hips\" }\n") ==
        "labs/lab.toml:1: expected the name of a place, such as waist: a number may be another "
        "node's id, found "
        "2 of node 1");
  CHECK(error_of(nodes + "{ \"1\" = \"02\" }\n")  // a node without a place too
            .ends_with("a number may be another node's id, found 02 of node 1"));
  CHECK(error_of(nodes + "{ \"1\" = \"1\", \"2\" = \"2nd\" }\n") == "none");
  CHECK(error_of("[device.a]\nprotocol = \"kinect\"\nskeleton = \"a.bvh\"\n") ==
        "labs/lab.toml:1: expected skeleton only for protocol noitom, found protocol kinect");
  CHECK(error_of("[device.a]\nprotocol = \"xsens\"\nskeleton = \"a.bvh\"\n") ==
        "labs/lab.toml:1: expected skeleton only for protocol noitom, found protocol xsens");
  CHECK(error_of("[device]\nport = 7012\n") ==
        "labs/lab.toml:2: expected [device.NAME], a table of its own for each, found port, "
        "7012");
  CHECK(error_of("device = 3\n") == "labs/lab.toml:1: expected device as a table, found 3");
  CHECK(error_of("[device.a\n").starts_with("labs/lab.toml:1: expected TOML, found a fault in it"));
}

TEST_CASE("a device is found by an IP address, never by a host's name") {
  const auto at = [](const std::string& address) {
    return error_of("[record]\n" + mocap + "transport = \"tcp\"\naddress = \"" + address + "\"\n");
  };
  for (const char* good : {"192.168.7.5", "fd00::1", "fe80::1%eth0"}) CHECK(at(good) == "none");
  for (const std::string bad : {"mocap-pc", "localhost", "192.168.7", "1.2.3.4%eth0", "[::1]"}) {
    CHECK(at(bad) ==
          "labs/lab.toml:2: expected an IP address (getent hosts NAME shows the address of a "
          "host), found " +
              bad);
  }
}

TEST_CASE("what comes in datagrams alone is told so before an address is asked for") {
  for (const std::string protocol : {"nodes", "slimevr"}) {
    for (const std::string transport : {"tcp", "tcp-listen"}) {
      const Lab lab{{*parse_device(fmt::format("imu={}:{}:5005", protocol, transport))}, {}};
      REQUIRE(!validate(lab));
      CHECK(to_string(validate(lab).error()) ==
            fmt::format("imu: expected transport udp, the only one of protocol {}, found {}",
                        protocol, transport));
    }
  }
}

TEST_CASE("two devices share a port at addresses of their own alone") {
  const auto fits = [](const std::string& a, const std::string& b) {
    return validate({{*parse_device("a=" + a), *parse_device("b=" + b)}, {}}).has_value();
  };
  CHECK(fits("noitom:udp:127.0.0.1:7012", "xsens:udp:127.0.0.2:7012"));
  CHECK(!fits("noitom:udp:127.0.0.1:7012", "xsens:udp:127.0.0.1:7012"));
  // "udp:7012" listens on all addresses.
  CHECK(!fits("noitom:udp:127.0.0.1:7012", "xsens:udp:7012"));
  CHECK(!fits("noitom:tcp-listen:7012", "kinect:tcp-listen:127.0.0.1:7012"));
  CHECK(fits("noitom:udp:7012", "kinect:tcp-listen:7012"));
  CHECK(fits("noitom:tcp:127.0.0.1:7012", "kinect:tcp:127.0.0.2:7012"));
}

TEST_CASE("what a flag says of a device's port wins, and leaves what else is known of it") {
  Lab lab{*read_devices(mocap + "skeleton = \"rig.bvh\"\n", "lab.toml"), {}};
  set_device(lab, *parse_device("mocap=noitom:tcp:10.0.0.1:7001"));
  set_device(lab, *parse_device("imu=nodes:5005"));
  REQUIRE(lab.devices.size() == 2);
  CHECK(lab.devices[0].transport == "tcp");
  CHECK(lab.devices[0].port == 7001);
  CHECK(lab.devices[0].skeleton == "rig.bvh");
  CHECK(lab.devices[1].name == "imu");
}

TEST_CASE("a device has a name that may stand on a screen and is none of the recorder's own") {
  for (const std::string name : {"m\x1b[2J", "m\nx", "marks", "trigger", "clock", "counts"}) {
    CAPTURE(name);
    Lab lab;
    lab.devices = {*parse_device("mocap=noitom:7012")};
    CHECK(validate(lab));
    lab.devices[0].name = name;
    REQUIRE(!validate(lab));
    CHECK(validate(lab).error().expected.starts_with("a name without control characters"));
  }
}
