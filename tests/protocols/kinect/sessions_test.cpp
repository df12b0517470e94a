// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/kinect/sessions.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

KinectMoment moment(std::uint32_t session, std::uint32_t sequence) {
  const std::int64_t ticks = 333'333 * std::int64_t{sequence};
  return {{2, session, sequence}, ticks, ticks};
}

}  // namespace

TEST_CASE("a Kinect's newest session wins, and frames of earlier ones are recognised") {
  KinectSessions sessions;
  CHECK(sessions.newest() == nullptr);
  CHECK(sessions.take(moment(1, 7)));
  CHECK(sessions.take(moment(1, 8)));
  CHECK(sessions.take(moment(1, 7)));
  CHECK(sessions.newest()->origin.sequence == 8);
  CHECK(sessions.take(moment(2, 0)));
  CHECK_FALSE(sessions.take(moment(1, 8)));
  CHECK_FALSE(sessions.take(moment(1, 9)));
  CHECK(sessions.newest()->origin.session == 2);
  CHECK(!sessions.overlap());
}

TEST_CASE("two sessions that send at the same time with one Kinect's id are found") {
  KinectSessions sessions;
  for (std::uint32_t k = 0; k < 17; ++k) {
    CAPTURE(k);
    CHECK(!sessions.overlap());
    CHECK(sessions.take(moment(1, k), "10.0.0.1:5") == (k == 0));
    CHECK(sessions.take(moment(2, k), "10.0.0.2:6"));
  }
  REQUIRE(sessions.overlap());
  const Finding finding =
      overlap_finding("kinect", *sessions.overlap(), "alignment takes one of them");
  CHECK(
      to_string(finding.what) ==
      "kinect: expected one sender of Kinect sensor 2, found two at a time: 10.0.0.1:5 in session "
      "1, 10.0.0.2:6 in session 2");
}

TEST_CASE("frames of an earlier session that are sent again are no overlap") {
  KinectSessions sessions;
  for (std::uint32_t k = 0; k < 50; ++k) sessions.take(moment(1, k));
  for (std::uint32_t k = 0; k < 50; ++k) {
    sessions.take(moment(2, k));
    CHECK_FALSE(sessions.take(moment(1, k)));
  }
  CHECK(!sessions.overlap());
}

TEST_CASE("a session that begins anew stands where its newer ticks are, not its greatest number") {
  KinectSessions sessions;
  sessions.take(moment(1, 1000));
  KinectMoment anew = moment(1, 3);
  anew.device_ticks = anew.sent_ticks = moment(1, 2000).sent_ticks;
  sessions.take(anew);
  CHECK(sessions.newest()->origin.sequence == 3);
  sessions.take(moment(1, 999));
  CHECK(sessions.newest()->origin.sequence == 3);
}
