// SPDX-License-Identifier: Apache-2.0
// The table of docs/performance.md: every method on every link, on the same traces.
//   kinalign_clock_table [--minutes M] [--seeds N] [--first SEED] [--links ABC] [--bursts]
#include "tools/clock_table/print.h"

#include <cstdlib>
#include <random>
#include <string_view>

using namespace kinalign;

namespace {

struct Wanted {
  double minutes = 1.0;
  std::uint64_t seeds = 20;
  std::uint64_t first = std::random_device{}();
  std::string links = "ABCDEFG";
  bool bursts = false;
};

Wanted parse(int argc, char** argv) {
  Wanted wanted;
  for (int i = 1; i < argc; ++i) {
    const std::string_view flag = argv[i];
    const char* value = i + 1 < argc ? argv[i + 1] : "";
    if (flag == "--bursts") {
      wanted.bursts = true;
      continue;
    }
    if (flag == "--minutes") wanted.minutes = std::strtod(value, nullptr);
    if (flag == "--seeds") wanted.seeds = std::strtoull(value, nullptr, 10);
    if (flag == "--first") wanted.first = std::strtoull(value, nullptr, 10);
    if (flag == "--links") wanted.links = value;
    ++i;
  }
  return wanted;
}

}  // namespace

int main(int argc, char** argv) {
  const Wanted wanted = parse(argc, argv);
  const RunSet set{wanted.minutes, wanted.seeds, wanted.first, wanted.bursts};
  std::vector<LinkRun> runs;
  for (const char link : wanted.links) runs.push_back({static_cast<Link>(link - 'A'), set});
  print_tables(set, measure(runs));
  return 0;
}
