// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/protocols.h"

#include <doctest/doctest.h>

#include <array>
#include <string>
#include <vector>

using namespace kinalign;

TEST_CASE("a protocol is found by its name in lab.toml and by its name in recordings") {
  struct Names {
    Protocol protocol;
    std::string_view name, recorded;
  };
  const std::array<Names, 5> all{{{Protocol::nodes, "nodes", "kinalign-node"},
                                  {Protocol::noitom, "noitom", "noitom"},
                                  {Protocol::xsens, "xsens", "xsens"},
                                  {Protocol::kinect, "kinect", "kinect"},
                                  {Protocol::slimevr, "slimevr", "slimevr"}}};
  CHECK(protocol_rows().size() == all.size());
  for (const auto& [protocol, name, recorded] : all) {
    CAPTURE(name);
    CHECK(row_of(protocol).protocol == protocol);
    CHECK(row_of(protocol).name == name);
    CHECK(row_of(protocol).recorded_name == recorded);
    CHECK(find_protocol(name) == protocol);
    CHECK(find_recorded_protocol(recorded) == protocol);
  }
  CHECK(protocol_names() ==
        std::vector<std::string>{"nodes", "noitom", "xsens", "kinect", "slimevr"});
}

TEST_CASE("the two names of the nodes' protocol do not stand for one another") {
  CHECK(!find_recorded_protocol("nodes"));
  CHECK(!find_protocol("kinalign-node"));
}

TEST_CASE("a text that is no protocol's name is not found, and the nearest name is given") {
  for (const char* text : {"", "kinet", "Kinect", "kinect ", "kinalign-exchange", "json"}) {
    CAPTURE(text);
    CHECK(!find_protocol(text));
    CHECK(!find_recorded_protocol(text));
  }
  CHECK(to_string(unknown_protocol("kinet")) ==
        "expected a known protocol (nearest: kinect), found \"kinet\"");
  CHECK(to_string(unknown_protocol("node")) ==
        "expected a known protocol (nearest: nodes), found \"node\"");
  CHECK(to_string(unknown_protocol("")) ==
        "expected a known protocol (known: nodes, noitom, xsens, kinect, slimevr), found \"\"");
}

TEST_CASE("nodes and trackers send datagrams, other devices may connect too") {
  for (const ProtocolRow& row : protocol_rows()) {
    CAPTURE(row.name);
    const bool datagrams_alone =
        row.protocol == Protocol::nodes || row.protocol == Protocol::slimevr;
    CHECK(row.transports.front() == Transport::udp);
    CHECK(may_come_over(row, Transport::udp));
    CHECK(may_come_over(row, Transport::tcp) != datagrams_alone);
    CHECK(may_come_over(row, Transport::tcp_listen) != datagrams_alone);
  }
}

TEST_CASE("each protocol has its kind of rows, its numbers and its answers") {
  const ProtocolRow& nodes = row_of(Protocol::nodes);
  CHECK(nodes.rows == ProtocolRows::imu);
  CHECK(nodes.losses == LossNumbers::datagrams);
  CHECK(nodes.answers == Answers::node_requests);
  CHECK(nodes.has_node_ids);
  CHECK(!nodes.has_frame_decoder);

  const ProtocolRow& noitom = row_of(Protocol::noitom);
  CHECK(noitom.rows == ProtocolRows::clip);
  CHECK(noitom.losses == LossNumbers::frame_heads);
  CHECK(noitom.answers == Answers::none);
  CHECK(noitom.has_frame_decoder);

  const ProtocolRow& xsens = row_of(Protocol::xsens);
  CHECK(xsens.rows == ProtocolRows::clip);
  CHECK(xsens.losses == LossNumbers::frames);
  CHECK(xsens.answers == Answers::none);
  CHECK(xsens.has_frame_decoder);

  const ProtocolRow& kinect = row_of(Protocol::kinect);
  CHECK(kinect.rows == ProtocolRows::points);
  CHECK(kinect.losses == LossNumbers::frames);
  CHECK(kinect.answers == Answers::kinect_pings);
  CHECK(kinect.has_frame_decoder);

  const ProtocolRow& slimevr = row_of(Protocol::slimevr);
  CHECK(slimevr.rows == ProtocolRows::imu);
  CHECK(slimevr.losses == LossNumbers::datagrams);
  CHECK(slimevr.answers == Answers::tracker_handshakes);
  CHECK(slimevr.has_frame_decoder);
}

TEST_CASE("what one protocol alone needs or has, no other one does") {
  for (const ProtocolRow& row : protocol_rows()) {
    CAPTURE(row.name);
    CHECK(row.needs_skeleton == (row.protocol == Protocol::noitom));
    CHECK(row.has_trackers == (row.protocol == Protocol::xsens));
    CHECK(row.has_node_ids == (row.protocol == Protocol::nodes));
    CHECK(row.is_named_by_address == (row.protocol == Protocol::slimevr));
    CHECK(row.usual_rate_hz == (row.protocol == Protocol::kinect ? 30.0 : 0.0));
  }
}

TEST_CASE("a transport is found by its name, and an unknown one is told the nearest") {
  CHECK(transport_names() == std::vector<std::string>{"udp", "tcp", "tcp-listen"});
  for (const Transport one : {Transport::udp, Transport::tcp, Transport::tcp_listen}) {
    CHECK(find_transport(name_of(one)) == one);
  }
  CHECK(!find_transport(""));
  CHECK(!find_transport("UDP"));
  CHECK(to_string(unknown_transport("udb")) ==
        "expected a known transport (nearest: udp), found \"udb\"");
}

TEST_CASE("bytes may be cut anywhere unless they came in datagrams") {
  CHECK(is_datagrams("udp"));
  for (const char* text : {"tcp", "tcp-listen", "", "quic"}) CHECK(!is_datagrams(text));
}
