// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/verbs.h"
#include "tests/apps/fake_verb.h"
#include "tests/folder.h"
#include "tests/io/recorded_lab.h"

#include <doctest/doctest.h>

#include <set>

using namespace kinalign;

namespace {

std::set<std::string> topics_in(const std::string& bytes) {
  std::set<std::string> topics;
  for (const McapRecord& record : read_mcap(bytes).records) {
    if (const auto* channel = std::get_if<McapChannel>(&record)) topics.insert(channel->topic);
  }
  return topics;
}

}  // namespace

TEST_CASE("of a recording the devices that give no rows are left out by name, all else is shown") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_node(12, 1, {3.0, -35.0}, 0.0, 5.0);
  lab.add_datagram({"imu", "kinalign-node", "udp", "10.0.0.66:9", "13", ""}, 1.0, "GET /");
  lab.add_mocap(NoitomForm::new_header, "udp", 5.0);
  lab.forget_skeleton();
  lab.add_mark(1.0, {Mark::Kind::start, "", std::nullopt, ""});
  const std::string path = folder.write("take.mcap", lab.file()), to = folder / "shown.mcap";
  const Outcome outcome = Machine{}.run_verb(convert_verb(), {"convert", path, to});
  CHECK(outcome.code == 1);
  CHECK(outcome.err.empty());
  CHECK(outcome.out.find("of stream mocap the skeleton") != std::string::npos);
  CHECK(outcome.out.find("mocap is left out") != std::string::npos);
  CHECK(outcome.out.find("imu 13 is left out") != std::string::npos);
  CHECK(topics_in(folder.read("shown.mcap")) == std::set<std::string>{"/imu/12", "/marks"});
}
