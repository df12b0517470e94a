// SPDX-License-Identifier: Apache-2.0
// The upper limit for a whole job: parses every number of the given files once, with
// std::from_chars, from memory. Prints the CPU seconds of the parsing alone.
#include <sys/resource.h>

#include <charconv>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

namespace {

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

}  // namespace

int main(int count, char** paths) {
  double all = 0.0;
  double sum = 0.0;
  for (int i = 1; i < count; ++i) {
    std::ifstream file(paths[i], std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const double before = cpu_seconds();
    const char *at = text.data(), *end = at + text.size();
    while (at < end) {
      double value = 0.0;
      const auto [behind, fault] = std::from_chars(at, end, value);
      at = fault == std::errc{} ? behind : at + 1;
      sum += value;
    }
    all += cpu_seconds() - before;
  }
  std::printf("{\"cpu_s\": %.4f, \"sum\": %g}\n", all, sum);
}
