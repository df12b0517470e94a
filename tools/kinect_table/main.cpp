// SPDX-License-Identifier: Apache-2.0
// The simulated Kinect beside the real one: docs/kinect_noise_figures.md has its table.
#include "tools/kinect_table/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

namespace kinalign {

namespace {

constexpr int done = 0, findings = 1, wrong_use = 2, failure = 3;

constexpr std::string_view help_page =
    R"(usage: kinalign_kinect_table PAIRS [--seeds N] [--bars | --markdown]

PAIRS: what tools/kinect_table/export_ui_prmd.py wrote of UI-PRMD, e.g.
  /usr/bin/python3 tools/kinect_table/export_ui_prmd.py build/ui_prmd.bin
  kinalign_kinect_table build/ui_prmd.bin --bars

  --seeds N    seeds 1 to N (20)
  --bars       exit with 1 where a band is missed
  --markdown   the table of docs/kinect_noise_figures.md
)";

struct Wanted {
  std::string pairs;
  std::size_t seeds = 20;
  bool bars = false, markdown = false, understood = true;
};

Wanted wanted_from(int argc, char** argv) {
  Wanted wanted;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--bars") {
      wanted.bars = true;
    } else if (word == "--markdown") {
      wanted.markdown = true;
    } else if (word == "--seeds" && i + 1 < argc) {
      wanted.seeds = static_cast<std::size_t>(std::max(0L, std::strtol(argv[++i], nullptr, 10)));
    } else if (!word.starts_with("--") && wanted.pairs.empty()) {
      wanted.pairs = word;
    } else {
      wanted.understood = false;
    }
  }
  wanted.understood = wanted.understood && !wanted.pairs.empty() && wanted.seeds > 0;
  return wanted;
}

int run(const Wanted& wanted) {
  std::ifstream in(wanted.pairs, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const auto pieces = read_pieces(bytes, wanted.pairs);
  if (!pieces) {
    fmt::print(stderr, "kinalign_kinect_table: {}\n", to_string(pieces.error()));
    return failure;
  }
  const auto rows = measured_rows(*pieces, wanted.seeds, std::thread::hardware_concurrency());
  if (!rows) {
    fmt::print(stderr, "kinalign_kinect_table: {}\n", to_string(rows.error()));
    return failure;
  }
  const bool met = std::all_of(rows->begin(), rows->end(), [](const Row& r) { return r.met(); });
  fmt::print("{}", wanted.markdown ? markdown(*rows, wanted.seeds) : plain(*rows));
  return met || !wanted.bars ? done : findings;
}

}  // namespace

}  // namespace kinalign

int main(int argc, char** argv) {
  const kinalign::Wanted wanted = kinalign::wanted_from(argc, argv);
  if (!wanted.understood) {
    fmt::print(stderr, "{}", kinalign::help_page);
    return kinalign::wrong_use;
  }
  return kinalign::run(wanted);
}
