// SPDX-License-Identifier: Apache-2.0
#include "tools/clock_table/print.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace kinalign {

namespace {

std::string line_of(const MethodFigures& f) {
  return fmt::format("| {} | {:.4f} | {:.4f} | {:.4f} | {:.4f} |", f.name, f.pooled * 1e3,
                     f.p99 * 1e3, f.worst_seed.value * 1e3, f.worst_stamp.value * 1e3);
}

std::string line_of(std::string_view name, const IntervalFigures& f) {
  return fmt::format(
      "{}: {} of {} stamps certified, {} of them wrong; half width {:.4f} ms, p99 {:.4f}", name,
      f.certified, f.frames, f.wrong, f.half_width * 1e3, f.half_width_p99 * 1e3);
}

std::string line_of(std::string_view name, const GainFigures& f) {
  return fmt::format("gain of offline over T2 - d, {}: median {:.0f}, least {:.0f} (seed {})", name,
                     f.median, f.least.value, f.least.seed.value());
}

void print_link(const LinkFigures& table) {
  fmt::print("\n| link {} | pooled RMS | p99 | worst seed's RMS | worst stamp |\n",
             letter(table.link));
  fmt::print("| --- | --- | --- | --- | --- |\n");
  for (const MethodFigures& row : table.rows) fmt::print("{}\n", line_of(row));
  fmt::print("\n{}\n{}\n", line_of("live", table.live), line_of("offline", table.offline));
  fmt::print("{}\n{}\n", line_of("each d", table.over_each_delay),
             line_of("mean d", table.over_mean_delay));
  for (const StartFigures& start : table.starts) {
    fmt::print("live error under {} ms after: median {:.2f} s, p90 {:.2f} s, worst {:.2f} s\n",
               start.limit * 1e3, start.median, start.p90, start.worst);
  }
}

/// Pooled RMS of each method on each link.
void print_overview(std::span<const LinkFigures> tables) {
  fmt::print("\n| pooled RMS, ms |");
  for (const LinkFigures& table : tables) fmt::print(" {} |", letter(table.link));
  fmt::print("\n| --- |");
  for (std::size_t i = 0; i < tables.size(); ++i) fmt::print(" --- |");
  for (std::size_t row = 0; row < methods; ++row) {
    fmt::print("\n| {} |", tables.front().rows[row].name);
    for (const LinkFigures& table : tables) fmt::print(" {:.3g} |", table.rows[row].pooled * 1e3);
  }
  fmt::print("\n");
}

std::string line_of(const Verdict& v) {
  const std::string seed = v.measured.seed ? fmt::format("seed {}", *v.measured.seed) : "";
  return fmt::format("| {:9} | {} | {:42} | {:>8.4g} | {} {:>6g} | {:6} | {} |", v.source,
                     letter(v.link), v.column, v.measured.value, v.at_least ? ">=" : "<=", v.bar,
                     v.met() ? "met" : "MISSED", seed);
}

}  // namespace

std::string describe(const RunSet& set) {
  return fmt::format("{} min{}, 15 frames a second, seeds {} to {}", set.minutes,
                     set.bursts ? " with bursts of loss" : "", set.first,
                     set.first + set.seeds - 1);
}

void print_tables(const RunSet& set, std::span<const LinkFigures> tables) {
  fmt::print("{}: ms\n", describe(set));
  for (const LinkFigures& table : tables) print_link(table);
  print_overview(tables);
}

void print_verdicts(const RunSet& set, std::span<const Verdict> verdicts) {
  fmt::print("{}: held against the promises\n\n", describe(set));
  fmt::print("| source | link | column | measured | bar | | worst of |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Verdict& verdict : verdicts) fmt::print("{}\n", line_of(verdict));
  const auto met = std::count_if(verdicts.begin(), verdicts.end(),
                                 [](const Verdict& verdict) { return verdict.met(); });
  fmt::print("\n{} met, {} missed\n", met, std::ssize(verdicts) - met);
}

}  // namespace kinalign
