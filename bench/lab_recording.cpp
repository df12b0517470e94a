// SPDX-License-Identifier: Apache-2.0
// A recording of a lab for lab_recording.py: mocap of 59 joints with places at 125 Hz, a Kinect at
// 30 Hz, five nodes of 100 samples a second; every value moves. It is made in memory: 2 GiB for an
// hour.
#define DOCTEST_CONFIG_IMPLEMENT
#include "tests/recording/recorded_lab.h"

#include <cstdlib>
#include <fstream>
#include <iostream>

using namespace kinalign;

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: lab_recording SECONDS FOLDER\n";
    return 2;
  }
  doctest::Context context;  // a failed check in the lab's code ends the program
  context.setAsDefaultForAssertsOutOfTestCases();
  const double seconds = std::atof(argv[1]);
  const std::string folder = argv[2];
  RecordedLab lab(7);
  lab.add_mocap(NoitomForm::new_header, "udp", seconds, 0, "10.0.0.3:7012", true);
  lab.add_kinect({100.0, 20.0}, {7.0, -15.0}, 0.030, seconds);
  std::string nodes;
  for (std::uint32_t id = 1; id <= 5; ++id) {
    lab.add_node(id, id, {3.0 * id, 10.0 * id - 30.0}, 0.1 * id, seconds, "", 50.0);
    nodes += (id > 1 ? ", \"" : "\"") + std::to_string(id) + "\" = \"take_01.mcap\"";
  }
  lab.add_clock(seconds, 1e9, 0.0);
  std::ofstream(folder + "/take_01.mcap", std::ios::binary) << lab.file();
  std::ofstream(folder + "/recording.toml")
      << "[stream.mocap]\nfile = \"take_01.mcap\"\n\n[stream.kinect]\nfile = \"take_01.mcap\"\n\n"
         "[stream.imu]\nfiles = { "
      << nodes << " }\n\n[space.kinect]\nmethod = \"none\"\n";
  return 0;
}
