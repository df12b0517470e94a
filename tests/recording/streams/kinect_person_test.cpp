// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/kinect_person.h"

#include <doctest/doctest.h>

#include <limits>

using namespace kinalign;

namespace {

struct Seen {
  std::uint64_t id = 0;
  float x = 0.0F;  // m; two metres in front of the sensor
};

KinectFrame frame_at(double t_s, const std::vector<Seen>& bodies, std::uint32_t session = 1) {
  KinectFrame frame;
  frame.origin.session = session;
  frame.device_ticks = static_cast<std::int64_t>(1e7 * t_s);
  for (const Seen& seen : bodies) {
    KinectBody body;
    body.id = seen.id;
    body.states.fill(2);
    for (std::size_t j = 0; j < 25; ++j) {
      body.positions[3 * j] = seen.x;
      body.positions[3 * j + 2] = 2.0F;
    }
    frame.bodies.push_back(body);
  }
  return frame;
}

std::string told(const KinectPerson& person) {
  Findings findings;
  person.report("take.mcap", findings);
  std::string text;
  for (const Finding& finding : findings) {
    text += finding.what.expected + ", " + finding.what.found + "; " + finding.meaning + "\n";
  }
  return text;
}

constexpr std::optional<std::uint64_t> nobody;

}  // namespace

TEST_CASE("of several bodies the one nearest to the sensor is followed, wherever it goes") {
  KinectPerson person(nobody);
  CHECK(person(frame_at(0.0, {{7, 1.5F}, {8, 0.2F}})) == 8);
  CHECK(person(frame_at(0.1, {{7, 0.0F}, {8, 3.0F}})) == 8);
  CHECK(told(person) ==
        "one body, several bodies in 2 frames; the body that was nearest to the sensor at the "
        "beginning is followed\n");
}

TEST_CASE("a bystander does not become the person who is gone, however near they stood") {
  KinectPerson person(nobody);
  CHECK(person(frame_at(0.0, {{8, 0.0F}})) == 8);
  CHECK(person(frame_at(1.0, {{8, 0.0F}, {7, 0.8F}})) == 8);
  for (double t = 1.1; t < 60.0; t += 1.0) CHECK(person(frame_at(t, {{7, 0.1F}})) == nobody);
  CHECK(person(frame_at(60.0, {{7, 0.1F}, {9, 0.4F}})) == 9);  // the person is found again
  CHECK(told(person).find("the followed person, 59 frames with only other bodies") !=
        std::string::npos);
}

TEST_CASE("who was not seen beside the person is taken for it as far away as one can walk") {
  KinectPerson person(nobody);
  CHECK(person(frame_at(0.0, {{8, 0.0F}})) == 8);
  CHECK(person(frame_at(0.1, {{9, 2.5F}})) == nobody);
  CHECK(person(frame_at(0.1, {{9, 0.9F}})) == 9);
  CHECK(person(frame_at(0.2, {})) == nobody);
  CHECK(person(frame_at(1.0, {{10, 3.4F}})) == nobody);
  CHECK(person(frame_at(2.0, {{10, 3.4F}})) == 10);
  CHECK(told(person).find("one body, 3 ids, one after the other") != std::string::npos);
}

TEST_CASE("one person whom the SDK sees twice at one place may go on as either") {
  KinectPerson person(nobody);
  CHECK(person(frame_at(0.0, {{8, 0.0F}, {9, 0.1F}})) == 8);
  CHECK(person(frame_at(0.1, {{9, 0.1F}})) == 9);
}

TEST_CASE("another run of the sender has ids and ticks of its own") {
  KinectPerson person(nobody);
  CHECK(person(frame_at(100.0, {{8, 0.0F}, {7, 3.0F}})) == 8);
  CHECK(person(frame_at(0.5, {{7, 0.1F}, {8, 3.0F}}, 2)) == 7);
}

TEST_CASE("joints that are missing or no numbers don't say where a body is") {
  KinectPerson person(nobody);
  KinectFrame frame = frame_at(0.0, {{7, 0.0F}, {8, 0.5F}});
  frame.bodies[0].positions.fill(std::numeric_limits<float>::quiet_NaN());
  CHECK(person(frame) == 8);
  frame = frame_at(0.1, {{8, 0.5F}});
  frame.bodies[0].states.fill(0);
  CHECK(person(frame) == 8);  // recognised by its id
}

TEST_CASE("an id that is asked for is taken alone") {
  KinectPerson person(7);
  CHECK(person(frame_at(0.0, {{8, 0.0F}})) == 7);
  CHECK(told(person).starts_with("body 7, 1 other ids; all joints are missing in all rows\n"));
}
