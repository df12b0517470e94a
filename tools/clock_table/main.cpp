// SPDX-License-Identifier: Apache-2.0
// The table of docs/performance.md: every method on every link, on the same traces.
//   kinalign_clock_table [--minutes M] [--seeds N] [--first SEED] [--links ABC] [--bursts]
#include "tools/clock_table/judge.h"
#include "tools/clock_table/peers.h"

#include "kinalign/core/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <string_view>
#include <vector>

using namespace kinalign;

namespace {

struct Wanted {
  double minutes = 1.0;
  std::uint64_t seeds = 20;
  std::uint64_t first = std::random_device{}();
  std::string links = "ABCDEFG";
  bool bursts = false;
};

constexpr double live_since_s = 10.0;  // the first seconds are those of convergence

/// Of one method over all seeds.
struct Row {
  std::string name;
  std::vector<std::vector<double>> errors;  // a vector a seed, s
};

struct Certified {
  std::uint64_t stamps = 0, certified = 0, wrong = 0;
  std::vector<double> half_widths;  // s, of frames sent from `begin` on

  void add(const JudgedRun& run, double begin) {
    stamps += run.frames;
    wrong += run.lies();
    for (const JudgedStamp& stamp : run.stamps) {
      if (!stamp.certified || stamp.withdrawn) continue;
      ++certified;
      if (stamp.sent >= begin) half_widths.push_back(stamp.half_width);
    }
  }
};

/// What the live error of a link is to stay under soon after the first frame (promise 4), s.
struct StartLimits {
  Link link;
  std::array<double, 2> limits;  // 0: none
};
constexpr std::array start_limits{
    StartLimits{Link::wired, {0.1e-3, 0.0}},   StartLimits{Link::quiet, {1e-3, 0.0}},
    StartLimits{Link::paper, {5e-3, 1e-3}},    StartLimits{Link::modem_sleep, {1e-3, 0.0}},
    StartLimits{Link::congested, {1e-3, 0.0}}, StartLimits{Link::roaming, {1e-3, 0.0}},
    StartLimits{Link::thin_floor, {5e-3, 0.0}}};

/// Seconds from the first frame until the error of all that follow within half a minute is small.
double start_time(const JudgedRun& run, double limit) {
  double last = run.stamps.empty() ? 0.0 : run.stamps.front().heard;
  for (const JudgedStamp& stamp : run.stamps) {
    if (stamp.sent < 30.0 && std::abs(stamp.error) > limit) last = stamp.heard;
  }
  return last;
}

struct Table {
  std::vector<Row> rows;
  Certified live, offline;
  std::array<std::vector<double>, 2> starts;  // s, a seed each, for each of the limits
  std::vector<double> gains;                  // over T2 - d, each and mean alike: the smaller
};

std::vector<double> since(const PeerErrors& found, double begin) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < found.sent.size(); ++i) {
    if (found.sent[i] >= begin) errors.push_back(found.error[i]);
  }
  return errors;
}

Table measure(Link link, const Wanted& wanted) {
  Table table;
  for (const Peer& peer : peers()) table.rows.push_back({std::string(peer.name), {}});
  for (const char* ours :
       {"kinalign, live", "  less asymmetry", "kinalign, offline", "  less asymmetry"}) {
    table.rows.push_back({ours, {}});
  }
  for (std::uint64_t seed = wanted.first; seed < wanted.first + wanted.seeds; ++seed) {
    ExchangeOptions options;
    options.length_s = 60.0 * wanted.minutes;
    options.link.link = link;
    options.link.bursts = wanted.bursts;
    const SimulatedExchanges run = simulate_exchanges(options, seed);
    std::size_t row = 0;
    for (const Peer& peer : peers()) {
      table.rows[row++].errors.push_back(since(peer.errors(run), peer.live ? live_since_s : 0.0));
    }
    const JudgedRun live = judge_live(run), offline = judge_offline(run);
    table.rows[row++].errors.push_back(errors_since(live, live_since_s));
    table.rows[row++].errors.push_back(errors_since(live, live_since_s, live.asymmetry));
    table.rows[row++].errors.push_back(errors_since(offline, 0.0));
    table.rows[row].errors.push_back(errors_since(offline, 0.0, offline.asymmetry));
    table.live.add(live, live_since_s);
    table.offline.add(offline, 0.0);
    const auto& limits = start_limits[static_cast<std::size_t>(link)].limits;
    for (std::size_t i = 0; i < limits.size(); ++i) {
      if (limits[i] > 0.0) table.starts[i].push_back(start_time(live, limits[i]));
    }
    const double paper = std::min(figures(peers()[0].errors(run).error).rms,
                                  figures(peers()[1].errors(run).error).rms);
    table.gains.push_back(paper / figures(errors_since(offline, 0.0)).rms);
  }
  return table;
}

std::vector<double> pooled(const Row& row) {
  std::vector<double> all;
  for (const auto& errors : row.errors) all.insert(all.end(), errors.begin(), errors.end());
  return all;
}

/// Pooled RMS, p99 averaged over seeds, worst of all, RMS of the worst seed: ms.
std::string line_of(const Row& row) {
  double p99 = 0.0, worst_seed = 0.0;
  for (const auto& errors : row.errors) {
    const ErrorFigures f = figures(errors);
    p99 += f.p99 / static_cast<double>(row.errors.size());
    worst_seed = std::max(worst_seed, f.rms);
  }
  const ErrorFigures f = figures(pooled(row));
  return fmt::format("| {} | {:.4f} | {:.4f} | {:.4f} | {:.4f} |", row.name, f.rms * 1e3, p99 * 1e3,
                     worst_seed * 1e3, f.worst * 1e3);
}

double at_share(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  return values[static_cast<std::size_t>(std::min(n - 1.0, n * share))];
}

std::string line_of(std::string_view name, const Certified& c) {
  double sum = 0.0;
  for (const double w : c.half_widths) sum += w;
  return fmt::format(
      "{}: {} of {} stamps certified, {} of them wrong; half width {:.4f} ms, p99 {:.4f}", name,
      c.certified, c.stamps, c.wrong, sum / static_cast<double>(c.half_widths.size()) * 1e3,
      at_share(c.half_widths, 0.99) * 1e3);
}

void print(Link link, const Table& table) {
  fmt::print("\n| link {} | pooled RMS | p99 | worst seed's RMS | worst stamp |\n", letter(link));
  fmt::print("| --- | --- | --- | --- | --- |\n");
  for (const Row& row : table.rows) fmt::print("{}\n", line_of(row));
  fmt::print("\n{}\n{}\n", line_of("live", table.live), line_of("offline", table.offline));
  fmt::print("gain of offline over T2 - d, the better of both: median {:.0f}, least {:.0f}\n",
             at_share(table.gains, 0.5), at_share(table.gains, 0.0));
  const auto& limits = start_limits[static_cast<std::size_t>(link)].limits;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    if (table.starts[i].empty()) continue;
    fmt::print("live error under {} ms after: median {:.2f} s, p90 {:.2f} s, worst {:.2f} s\n",
               limits[i] * 1e3, at_share(table.starts[i], 0.5), at_share(table.starts[i], 0.9),
               at_share(table.starts[i], 1.0));
  }
}

/// Pooled RMS of each method on each link.
void print_overview(const std::string& links, const std::vector<Table>& tables) {
  fmt::print("\n| pooled RMS, ms |");
  for (const char link : links) fmt::print(" {} |", link);
  fmt::print("\n| --- |");
  for (std::size_t i = 0; i < links.size(); ++i) fmt::print(" --- |");
  for (std::size_t row = 0; row < tables[0].rows.size(); ++row) {
    fmt::print("\n| {} |", tables[0].rows[row].name);
    for (const Table& table : tables) {
      fmt::print(" {:.3g} |", figures(pooled(table.rows[row])).rms * 1e3);
    }
  }
  fmt::print("\n");
}

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
  std::vector<Table> tables(wanted.links.size());
  parallel_for(wanted.links.size(), 2, [&](std::size_t i) {
    tables[i] = measure(static_cast<Link>(wanted.links[i] - 'A'), wanted);
  });
  fmt::print("{} min, 15 frames a second, seeds {} to {}: ms\n", wanted.minutes, wanted.first,
             wanted.first + wanted.seeds - 1);
  for (std::size_t i = 0; i < tables.size(); ++i) {
    print(static_cast<Link>(wanted.links[i] - 'A'), tables[i]);
  }
  print_overview(wanted.links, tables);
  return 0;
}
