// SPDX-License-Identifier: Apache-2.0
#include "kinalign/wire/clockless.h"

#include "firmware/node/clockless_node.h"
#include "tests/firmware/fake_board.h"

using namespace kinalign;

namespace {

struct Exchange {
  explicit Exchange(bool keyed = false)
      : node(board, {.node_id = 7, .boot_id = 9, .has_key = keyed, .key = node_key}),
        key(keyed ? &node_key : nullptr) {
    node.set_link(true);
  }
  ClocklessRequest request() {
    node.tick(1);
    return decoded<ClocklessRequest>(board.sent.back(), key);
  }
  Bytes answer_to(const DatagramOrigin& origin) {
    return encoded(ClocklessAnswer{origin, {0x1badcafe, 1'000, 2'000}}, key);
  }
  void arrive(Bytes datagram) {
    board.arriving.push_back(std::move(datagram));
    node.poll();
  }

  FakeBoard board;
  ClocklessNode node;
  const MacKey* key;
};

}  // namespace

TEST_CASE(
    "a clockless node requests with the sample of now, confirms at once, asks for no counter") {
  for (const bool keyed : {false, true}) {
    CAPTURE(keyed);
    Exchange exchange(keyed);
    exchange.board.reading.has_acceleration = true;
    const auto first = exchange.request();
    CHECK(first.origin == DatagramOrigin{7, 9, 0});
    CHECK(first.has_sample);
    CHECK(first.sample == exchange.board.reading);
    exchange.arrive(exchange.answer_to(first.origin));
    REQUIRE(exchange.board.sent.size() == 2);
    const auto confirm = decoded<ClocklessConfirm>(exchange.board.sent.back(), exchange.key);
    CHECK(confirm == ClocklessConfirm{{7, 9, 0}, {0x1badcafe, 1'000, 2'000}});
    CHECK(exchange.request().origin.sequence == 1);
    CHECK(exchange.board.calls.find('c') == std::string::npos);
    CHECK(exchange.board.shown.back() == Lights{true, SyncLight::answered, BatteryLight::unknown});
  }
}

TEST_CASE("an answer is confirmed once, and one that was made up never") {
  Exchange exchange(true);
  const auto origin = exchange.request().origin;
  const Bytes answer = exchange.answer_to(origin);
  exchange.arrive(answer);
  exchange.arrive(answer);
  exchange.arrive(encoded(ClocklessAnswer{origin, {}}));  // no MAC
  exchange.arrive(exchange.answer_to({7, 9, 1}));
  exchange.arrive(exchange.answer_to({7, 8, 0}));
  const ClocklessCounts& counts = exchange.node.counts();
  CHECK(exchange.board.sent.size() == 2);
  CHECK(counts.confirms == 1);
  CHECK(counts.answers.not_newer == 1);
  CHECK(counts.answers.unknown_frame == 1);
  CHECK(counts.answers.other_boot == 1);
  CHECK(counts.answers.refused[static_cast<std::size_t>(NodeRefusal::no_mac)] == 1);
}

TEST_CASE("a clockless node goes on without answers, sensor, link or radio") {
  Exchange exchange;
  exchange.board.imu_answers = false;
  CHECK(!exchange.request().has_sample);
  exchange.node.tick(3);
  exchange.node.set_link(false);
  exchange.node.tick(1);
  CHECK(exchange.board.sent.size() == 2);
  exchange.node.set_link(true);
  exchange.board.radio_takes = false;
  exchange.node.tick(1);
  exchange.board.radio_takes = true;
  exchange.board.battery_mv = 3000;
  const auto request = exchange.request();
  CHECK(request.origin.sequence == 3);
  CHECK(request.battery_mv == 3000);
  const ClocklessCounts& counts = exchange.node.counts();
  CHECK(counts.requests == 3);
  CHECK(counts.request_fails == 1);
  CHECK(counts.missed == 2);
  CHECK(counts.sensor_fails == 4);
}

TEST_CASE("the light goes out when 45 requests were not answered") {
  Exchange exchange;
  exchange.arrive(exchange.answer_to(exchange.request().origin));
  for (int i = 0; i < 45; ++i) exchange.node.tick(1);
  CHECK(exchange.board.shown.back().sync == SyncLight::answered);
  exchange.node.tick(1);
  CHECK(exchange.board.shown.back().sync == SyncLight::unanswered);
}
