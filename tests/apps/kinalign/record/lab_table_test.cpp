// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/lab_table.h"

#include "apps/cli/terminal.h"
#include "tests/apps/kinalign/text/lab_scene.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

constexpr std::size_t wide = 200;

std::vector<TableLine> table(const Scene& scene, std::size_t width = wide) {
  return lab_table(scene.lab, scene.status, width);
}

}  // namespace

TEST_CASE("a lab's table has a line for each sender, and one for each device that lacks") {
  const auto lines = table(Scene());
  REQUIRE(lines.size() == 5);
  CHECK(lines[0].text ==
        "device          rate/s lost late dup        last                  clock   ppm battery "
        "recorded link");
  CHECK(lines[1].text ==
        "mocap     124.9 of 125    3    0   0       0.1 s                                      "
        " 11.1 MB udp 192.168.7.5:51234");
  CHECK(!lines[1].bad);
  CHECK(lines[2].text.starts_with("kinect       0.0 of 30    3    0   0 silent 10 s "));
  CHECK(lines[2].bad);
  CHECK(lines[3].text ==
        "imu waist        124.9    3    0   0       0.1 s -1000.0000 s ± 1.04 ms +20.1  3.70 V "
        " 11.1 MB udp 192.168.7.5:51234");
  CHECK(lines[4].text == "imu wrist missing: nothing yet, 60 s");
  CHECK(lines[4].bad);
}

TEST_CASE("a narrow table leaves out columns from the right") {
  const Scene scene;
  const auto at_80 = table(scene, 79);
  CHECK(at_80[0].text ==
        "device          rate/s lost late dup        last                  clock   ppm");
  for (std::size_t width = 45; width <= wide; ++width) {
    CAPTURE(width);
    for (const TableLine& line : table(scene, width)) CHECK(places(line.text) <= width);
  }
}

TEST_CASE("a column that nobody has anything for is left out") {
  Scene scene;
  scene.lab.devices.resize(2);
  const auto lines = table(scene);
  REQUIRE(lines.size() == 3);
  CHECK(lines[0].text == "device       rate/s lost late dup        last recorded link");
}

TEST_CASE("what a port lost stands red below its device, required or not") {
  Scene scene;
  scene.lab.devices[0].required = false;
  PortCounts counts;
  counts.pieces = 7500;
  scene.status.ports = {{"mocap", counts}, {"kinect", counts}, {"marks", counts}};
  CHECK(table(scene).size() == 5);
  scene.status.ports[0].second.dropped = 1234;
  scene.status.ports[2].second.refused = 2;
  const auto lines = table(scene);
  REQUIRE(lines.size() == 7);
  CHECK(lines[2].text == "mocap     1,234 dropped by the kernel");
  CHECK(lines[2].bad);
  CHECK(!lines[1].bad);
  CHECK(lines[6].text == "marks     2 refused, not recorded");
}

TEST_CASE("a sender that another has replaced is not missing, and soon not shown") {
  Scene scene;
  StreamStatus again = scene.status.streams[1];  // the silent Kinect
  again.sender = "192.168.7.5:51300";
  again.last_arrival = scene.status.now;
  scene.status.streams.push_back(again);
  const auto lines = table(scene);
  REQUIRE(lines.size() == 6);
  CHECK(!lines[2].bad);
  CHECK(!lines[3].bad);
  scene.status.now += 25s;
  scene.status.streams.back().last_arrival = scene.status.now;
  CHECK(table(scene).size() == 5);
}

TEST_CASE("what is not required is missing without red") {
  Scene scene;
  for (DeviceOptions& device : scene.lab.devices) device.required = false;
  const auto lines = table(scene);
  for (const TableLine& line : lines) CHECK(!line.bad);
  CHECK(lines[4].text == "imu wrist nothing yet, 60 s");
  CHECK(missing(scene.lab, scene.status).empty());
}

TEST_CASE("while nobody is heard there is no head: it would be one word") {
  Scene scene;
  scene.status.streams.clear();
  const auto lines = table(scene);
  REQUIRE(lines.size() == 4);
  CHECK(lines[0].text == "mocap     missing: nothing yet, 60 s");
  CHECK(!lines[0].head);
  CHECK(table(Scene())[0].head);
}

TEST_CASE(
    "a table that is too long begins with its bad lines, and says how many lines are left out") {
  const std::vector<TableLine> lines{{"head", false, true}, {"a"}, {"b", true}, {"c"},
                                     {"d", true},           {"e"}};
  const auto text = [&](std::size_t rows) {
    std::string all;
    for (const TableLine& line : fitted(lines, rows)) all += line.text + (line.bad ? "! " : " ");
    return all;
  };
  CHECK(text(7) == "head a b! c d! e ");
  CHECK(text(6) == text(7));
  CHECK(text(5) == "head b! d! a … 2 more ");
  CHECK(text(4) == "head b! d! … 3 more ");
  CHECK(text(3) == "head b! … 4 more! ");
  CHECK(text(1) == "… 6 more! ");
  CHECK(text(0).empty());
  CHECK(fitted({}, 0).empty());
}
