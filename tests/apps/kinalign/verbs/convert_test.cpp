// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/verbs.h"
#include "tests/apps/cli/fake_verb.h"
#include "tests/folder.h"
#include "tests/recording/recorded_lab.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <vector>

using namespace kinalign;

namespace {

/// The log times of a topic's messages, in the file's order, ns.
std::vector<std::uint64_t> times_of(const std::string& topic, const std::string& bytes) {
  const ReadMcap read = read_mcap(bytes);
  std::set<std::uint16_t> ids;
  for (const McapRecord& record : read.records) {
    const auto* channel = std::get_if<McapChannel>(&record);
    if (channel != nullptr && channel->topic == topic) ids.insert(channel->id);
  }
  std::vector<std::uint64_t> times;
  for (const OwnedMessage& one : read.messages) {
    if (ids.contains(one.message.channel)) times.push_back(one.message.log_time);
  }
  return times;
}

std::set<std::string> topics_in(const std::string& bytes) {
  std::set<std::string> topics;
  for (const McapRecord& record : read_mcap(bytes).records) {
    if (const auto* channel = std::get_if<McapChannel>(&record)) topics.insert(channel->topic);
  }
  return topics;
}

}  // namespace

TEST_CASE("devices of a recording without rows are left out by name, all others are shown") {
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
  CHECK(outcome.out.find("a skeleton for stream mocap") != std::string::npos);
  CHECK(outcome.out.find("mocap is left out") != std::string::npos);
  CHECK(outcome.out.find("imu 13 is left out") != std::string::npos);
  CHECK(topics_in(folder.read("shown.mcap")) == std::set<std::string>{"/imu/12", "/marks"});
}

TEST_CASE(
    "a Kinect's frame that too many have overtaken is left out, and convert and align say so") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_kinect({100.0, 20.0}, {7.0, -15.0}, 0.030, 20.0);
  lab.hold_back(200, 1.5);  // two frames are delayed; some 45 later frames arrive before them
  const std::string path = folder.write("take.mcap", lab.file());
  const std::string said =
      "take.mcap: expected frames that arrive after at most 16 newer ones, found 2 that arrived "
      "later";

  const Outcome shown =
      Machine{}.run_verb(convert_verb(), {"convert", path, folder / "shown.mcap"});
  CHECK(shown.code == 1);
  CHECK(shown.out.find(said) != std::string::npos);
  const auto times = times_of("/kinect/points", folder.read("shown.mcap"));
  CHECK(times.size() == 598);
  CHECK(std::is_sorted(times.begin(), times.end()));

  const Outcome aligned =
      Machine{}.run_verb(align_verb(), {"align", path, "-o", folder / "take.h5"});
  CHECK(aligned.code == 1);
  CHECK(aligned.out.find(said) != std::string::npos);
}
