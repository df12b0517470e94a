// SPDX-License-Identifier: Apache-2.0
// Text to doubles and back on the motion part of a BVH file (354 values of 4 decimals a row),
// against std::from_chars and std::to_chars in the same loops.
#include "kinalign/core/numbers.h"

#include <benchmark/benchmark.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

using namespace kinalign;

namespace {

constexpr std::size_t rows = 3000, columns = 354, all = rows * columns;

enum class Digits { of_file, any };

std::vector<double> motion(Digits digits) {
  std::mt19937_64 random(1);
  std::vector<double> values(all);
  for (std::size_t c = 0; c < columns; ++c) {
    const auto size = static_cast<double>(random() % 9000) / 100.0;
    const auto rate = static_cast<double>(random() % 1000) / 3000.0;
    for (std::size_t r = 0; r < rows; ++r) {
      const double v = size * std::sin(rate * static_cast<double>(r) / 10.0 + size);
      values[r * columns + c] = digits == Digits::any ? v : std::nearbyint(v * 1e4) / 1e4;
    }
  }
  return values;
}

template <class Put>
char* write_all(const std::vector<double>& values, char* at, Put put) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    at = put(at, values[i]);
    *at++ = i % columns + 1 == columns ? '\n' : ' ';
  }
  return at;
}

template <class Parse>
void read_all(const std::string& text, std::vector<double>& values, Parse parse) {
  const char *at = text.data(), *end = at + text.size();
  double* to = values.data();
  for (;;) {
    while (at < end && static_cast<unsigned char>(*at) <= ' ') ++at;
    if (at >= end) break;
    at = parse(at, end, *to++);
  }
}

const char* by_from_chars(const char* at, const char* end, double& value) {
  return std::from_chars(at, end, value).ptr;
}
const char* by_kinalign(const char* at, const char* end, double& value) {
  const char* behind = parse_number(at, end, value);
  if (behind == nullptr) std::abort();
  return behind;
}
char* shortest(char* at, double value) { return std::to_chars(at, at + number_room, value).ptr; }
char* fixed_by_to_chars(char* at, double value) {
  return std::to_chars(at, at + number_room, value, std::chars_format::fixed, 4).ptr;
}
char* four_decimals(char* at, double value) { return put_number(at, value, 4); }

template <auto parse>
void parsing(benchmark::State& state) {
  std::string text(all * (number_room + 1), '\0');
  text.resize(static_cast<std::size_t>(
      write_all(motion(Digits::of_file), text.data(), fixed_by_to_chars) - text.data()));
  std::vector<double> values(all);
  for (auto _ : state) {
    read_all(text, values, parse);
    benchmark::DoNotOptimize(values.data());
  }
  if (values != motion(Digits::of_file)) std::abort();
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}

template <auto put, Digits digits>
void printing(benchmark::State& state) {
  const std::vector<double> values = motion(digits);
  std::string text(all * (number_room + 1), '\0');
  for (auto _ : state) benchmark::DoNotOptimize(write_all(values, text.data(), put));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all));
}

BENCHMARK(parsing<by_from_chars>)->Name("parse/from_chars")->Unit(benchmark::kMillisecond);
BENCHMARK(parsing<by_kinalign>)->Name("parse/kinalign")->Unit(benchmark::kMillisecond);
BENCHMARK(printing<shortest, Digits::of_file>)
    ->Name("print_file_like/to_chars")
    ->Unit(benchmark::kMillisecond);
BENCHMARK(printing<fixed_by_to_chars, Digits::of_file>)
    ->Name("print_fixed/to_chars")
    ->Unit(benchmark::kMillisecond);
BENCHMARK(printing<four_decimals, Digits::of_file>)
    ->Name("print_file_like/kinalign")
    ->Unit(benchmark::kMillisecond);
BENCHMARK(printing<shortest, Digits::any>)
    ->Name("print_any/to_chars")
    ->Unit(benchmark::kMillisecond);
BENCHMARK(printing<four_decimals, Digits::any>)
    ->Name("print_any/kinalign")
    ->Unit(benchmark::kMillisecond);

}  // namespace
