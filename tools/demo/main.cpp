// SPDX-License-Identifier: Apache-2.0
// kinalign_demo_recording OUT_DIR: writes the files that a suit, a Kinect and five nodes would
// write about one person who waves, bends and steps. It streams to disk: an hour needs no more
// memory than a minute.
#include "apps/cli/command_line.h"
#include "tools/demo/devices.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace kinalign {

namespace {

struct Wish {
  std::vector<std::string> folder;
  double seconds = 60;
  std::int64_t seed = 1, takes = 1;
  std::string subject = "S01", action = "wave, bend, step";
};

Usage describe(Wish& o) {
  Usage usage;
  usage.positionals = {{"OUT_DIR", "the folder to write into", &o.folder}};
  usage.flags = {
      {"seconds", "length of a take, s", &o.seconds, 1.0, 86'400.0},
      {"seed", "of sizes, rates and noise", &o.seed, 0.0, 9e15},
      {"takes", "folders take_001, take_002, ... where more than one", &o.takes, 1.0, 999},
      {"subject", "who", &o.subject},
      {"action", "what", &o.action}};
  return usage;
}

Result<void> make_folder(const std::string& path) {
  if (::mkdir(path.c_str(), 0777) == 0 || errno == EEXIST) return {};
  return Failure(Error{path, 0, "a folder that can be made", std::strerror(errno)});
}

Result<void> write_take(const DemoTake& take) {
  KA_TRY(make_folder(take.folder));
  double scale = 0;
  for (const char c : take.subject) scale += 0.37 * static_cast<unsigned char>(c);
  const DemoMotion motion(
      demo_body(0.95 + 0.1 * (scale - static_cast<double>(static_cast<long>(scale)))), take.seed);
  KA_TRY(write_demo_mocap(take, motion));
  KA_TRY(write_demo_kinect(take, motion));
  KA_TRY(write_demo_imus(take, motion));
  return write_demo_manifest(take);
}

Result<void> write_all(const Wish& wish) {
  PosixFiles files;
  const std::string& folder = wish.folder.front();
  KA_TRY(make_folder(folder));
  for (std::int64_t i = 0; i < wish.takes; ++i) {
    const std::string number = std::to_string(1001 + i).substr(1);
    const std::string place = folder + (wish.takes == 1 ? "/" : "/take_" + number + "/");
    KA_TRY(write_take({files, place, wish.seconds, static_cast<std::uint64_t>(wish.seed + i),
                       wish.subject, wish.action}));
  }
  return {};
}

int run(const std::vector<std::string>& words) {
  Wish wish;
  const Usage usage = describe(wish);
  const auto parsed = parse_words(words, usage, {});
  if (!parsed || parsed->help) {
    std::fprintf(stderr,
                 "usage: kinalign_demo_recording OUT_DIR [--seed N] [--seconds S] [--takes N] "
                 "[--subject TEXT] [--action TEXT]\n");
    if (!parsed) std::fprintf(stderr, "%s\n", to_string(parsed.error()).c_str());
    return 2;
  }
  const auto written = write_all(wish);
  if (!written) std::fprintf(stderr, "%s\n", to_string(written.error()).c_str());
  return written ? 0 : 3;
}

}  // namespace

}  // namespace kinalign

int main(int argc, char** argv) { return kinalign::run({argv + 1, argv + argc}); }
