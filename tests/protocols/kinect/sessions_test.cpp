// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/kinect/sessions.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

using Turn = KinectSessions::Turn;

KinectMoment moment(std::uint32_t session, std::uint32_t sequence) {
  const std::int64_t ticks = 333'333 * std::int64_t{sequence};
  return {{2, session, sequence}, ticks, ticks};
}

}  // namespace

TEST_CASE("a Kinect's session is over once another one has begun") {
  KinectSessions sessions;
  CHECK(sessions.hear(moment(1, 7)) == Turn::fresh);
  CHECK(sessions.hear(moment(1, 8)) == Turn::newest);
  CHECK(sessions.hear(moment(1, 7)) == Turn::newest);
  CHECK(sessions.stand(1)->origin.sequence == 8);
  CHECK(sessions.hear(moment(2, 0)) == Turn::fresh);
  CHECK(sessions.hear(moment(1, 8)) == Turn::over);
  CHECK(sessions.newest()->origin.session == 2);
  CHECK(sessions.stand(3) == nullptr);
  CHECK(!sessions.twins());
}

TEST_CASE("two senders that speak by turns with one Kinect's id are found") {
  KinectSessions sessions;
  for (std::uint32_t k = 0; k < 17; ++k) {
    CAPTURE(k);
    CHECK(sessions.hear(moment(1, k), "10.0.0.1:5") == (k == 0 ? Turn::fresh : Turn::beside));
    CHECK(sessions.is_beside(1) == (k == 16));
    sessions.hear(moment(2, k), "10.0.0.2:6");
  }
  CHECK(sessions.beside() == 1);
  REQUIRE(sessions.twins());
  const Finding told = two_senders("kinect", *sessions.twins(), "alignment takes one of them");
  CHECK(
      to_string(told.what) ==
      "kinect: expected one sender of Kinect sensor 2, found two at a time: 10.0.0.1:5 in session "
      "1, 10.0.0.2:6 in session 2");
}

TEST_CASE("frames of a session before that were held back in one piece are no second sender") {
  KinectSessions sessions;
  sessions.hear(moment(1, 0));
  sessions.hear(moment(2, 0));
  for (std::uint32_t k = 1; k < 500; ++k) sessions.hear(moment(1, k));
  for (std::uint32_t k = 1; k < 500; ++k) sessions.hear(moment(2, k));
  CHECK(!sessions.twins());
}

TEST_CASE("frames of a session before that are sent again between newer ones are no second one") {
  KinectSessions sessions;
  for (std::uint32_t k = 0; k < 50; ++k) sessions.hear(moment(1, k));
  for (std::uint32_t k = 0; k < 50; ++k) {
    sessions.hear(moment(2, k));
    CHECK(sessions.hear(moment(1, k)) == Turn::over);
  }
  CHECK(!sessions.twins());
}

TEST_CASE("a session that begins anew stands where its newer ticks are, not its greatest number") {
  KinectSessions sessions;
  sessions.hear(moment(1, 1000));
  KinectMoment anew = moment(1, 3);
  anew.device_ticks = anew.sent_ticks = moment(1, 2000).sent_ticks;
  sessions.hear(anew);
  CHECK(sessions.newest()->origin.sequence == 3);
  sessions.hear(moment(1, 999));
  CHECK(sessions.newest()->origin.sequence == 3);
}
