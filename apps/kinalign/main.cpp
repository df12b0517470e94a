// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/program.h"
#include "apps/kinalign/verbs.h"

#include <unistd.h>

#include <array>
#include <climits>
#include <cstdlib>

/// Collects everything that verbs get from the operating system. No other code reads the
/// environment.
int main(int argc, char** argv) {
  kinalign::PosixFiles files;
  // getcwd fails if the current folder was removed. The root is then taken as the current folder.
  std::array<char, PATH_MAX> folder{};
  const auto variable = [](const std::string& name) -> std::string {
    const char* value = std::getenv(name.c_str());
    return value == nullptr ? "" : value;
  };
  const kinalign::Surroundings surroundings{
      .variable = variable,
      .folder = ::getcwd(folder.data(), folder.size()) == nullptr ? "/" : folder.data(),
      .out_is_terminal = ::isatty(STDOUT_FILENO) == 1,
      .err_is_terminal = ::isatty(STDERR_FILENO) == 1,
      .files = files};
  return kinalign::run_program(kinalign::all_verbs(), {argv + 1, argv + argc}, surroundings);
}
