// SPDX-License-Identifier: Apache-2.0
// A verb with every kind of option, and a machine to run it on, for tests of the command-line
// frame.
#pragma once

#include "apps/cli/console.h"
#include "apps/cli/program.h"
#include "apps/cli/verb.h"

#include <sys/mman.h>
#include <unistd.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace kinalign {

struct Mix {
  double gap_ms = 50;
  std::int64_t rows = 3;
  std::string rotations = "spline";
  bool store_double = false;
  std::optional<double> interval_ms;
  std::vector<std::string> imu;
  std::vector<std::string> files;
};

inline Usage describe_mix(Mix& o) {
  Usage usage;
  usage.positionals = {{"FILE", "a file to mix", &o.files, 1, 9}};
  usage.flags = {{"imu", "a node's file, NODE=FILE", &o.imu}};
  usage.settings = {
      {"gap_ms", "longest gap, ms", &o.gap_ms, 0.0},
      {"rows", "how many", &o.rows, 1.0, 10.0},
      {.name = "rotations",
       .meaning = "between samples",
       .value = &o.rotations,
       .choices = {"spline", "slerp"}},
      {"double", "store 8-byte numbers", &o.store_double},
      {"interval_ms", "half-width, ms", &o.interval_ms, 0.0, 1000.0},
  };
  usage.check = [&o](const Common&, const Sources&) -> Result<void> {
    for (const std::string& one : o.imu) {
      if (one.find('=') == std::string::npos) return Failure(Error{"--imu", 0, "NODE=FILE", one});
    }
    return {};
  };
  return usage;
}

/// The work of the verb after its options are read; each test gives its own.
using Job = std::function<Result<int>(Mix&, Call&)>;

inline Verb mix_verb(const Job& job) {
  Page page{
      "mix", "mix files", "", {{"kinalign mix a.bvh", "mixes"}}, {"out", "force", "json", "jobs"}};
  return {page, [job](const auto& fill, const auto& call) -> Result<int> {
            Mix options;
            Usage usage = describe_mix(options);
            if (!fill(usage)) return 0;
            Call made = call();
            return job(options, made);
          }};
}

/// The result of one run.
struct Outcome {
  int code;
  std::string out, err;
};

inline std::string all_of(int fd) {
  std::string text(static_cast<std::size_t>(::lseek(fd, 0, SEEK_END)), '\0');
  const auto got = ::pread(fd, text.data(), text.size(), 0);
  text.resize(static_cast<std::size_t>(got < 0 ? 0 : got));
  return text;
}

/// The machine: variables, a folder, and whether stdout and stderr are terminals.
struct Machine {
  std::map<std::string, std::string> variables{};
  std::string folder = "/";
  bool out_is_terminal = false, err_is_terminal = false;
  int out = -1;  // file descriptor for stdout; -1: stdout goes to Outcome::out

  Outcome run(const Job& job, const std::vector<std::string>& words) const {
    return run_verb(mix_verb(job), words);
  }
  Outcome run_verb(const Verb& verb, const std::vector<std::string>& words) const {
    PosixFiles files;
    const int held_out = ::memfd_create("out", 0);
    const int err = ::memfd_create("err", 0);
    const Surroundings surroundings{.variable =
                                        [this](const std::string& name) {
                                          const auto found = variables.find(name);
                                          return found == variables.end() ? std::string()
                                                                          : found->second;
                                        },
                                    .folder = folder,
                                    .out = out < 0 ? held_out : out,
                                    .err = err,
                                    .out_is_terminal = out_is_terminal,
                                    .err_is_terminal = err_is_terminal,
                                    .files = files};
    Outcome outcome{run_program({verb}, words, surroundings), "", ""};
    outcome.out = all_of(held_out);
    outcome.err = all_of(err);
    ::close(held_out);
    ::close(err);
    return outcome;
  }
};

inline Result<int> nothing(Mix& /*options*/, Call& /*call*/) { return 0; }

}  // namespace kinalign
