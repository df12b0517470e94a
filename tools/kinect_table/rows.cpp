// SPDX-License-Identifier: Apache-2.0
#include "tools/kinect_table/rows.h"

#include "tools/kinect_table/rehearse.h"

#include "kinalign/core/parallel.h"

#include <fmt/format.h>

#include <algorithm>

namespace kinalign {

namespace {

/// The mean of a figure over all seeds.
template <class Pick>
double mean(const std::vector<Figures>& all, const Pick& pick) {
  double sum = 0.0;
  for (const Figures& f : all) sum += pick(f);
  return sum / static_cast<double>(all.size());
}

Row around(std::string name, double real, double share, double simulated) {
  return {std::move(name), real, real * (1.0 - share), real * (1.0 + share), simulated};
}
Row within_factor(std::string name, double real, double factor, double simulated) {
  return {std::move(name), real, real / factor, real * factor, simulated};
}
Row give_or_take(std::string name, double real, double by, double simulated) {
  return {std::move(name), real, real - by, real + by, simulated};
}

// The bands are those of «acceptance targets» of the reference, its section 7.8.
void add_marks(const Figures& real, const std::vector<Figures>& all, std::vector<Row>& rows) {
  struct Mark {
    std::string_view name;
    double Figures::*figure;
    double share;
  };
  for (const auto& [name, figure, share] :
       {Mark{"MPJPE, cm", &Figures::mpjpe, 0.10}, Mark{"PA-MPJPE, cm", &Figures::pa, 0.10},
        Mark{"bone error, cm", &Figures::bone, 0.15},
        Mark{"bone constancy, cm", &Figures::constancy, 0.15},
        Mark{"acceleration error, mm/frame²", &Figures::acceleration, 0.20},
        Mark{"… after Savitzky–Golay 9/2", &Figures::acceleration_smoothed, 0.20}}) {
    rows.push_back(around(std::string(name), real.*figure, share,
                          mean(all, [figure = figure](const Figures& f) { return f.*figure; })));
  }
  rows.push_back({"jitter, times the truth's", real.jitter, 30.0, 55.0,
                  mean(all, [](const Figures& f) { return f.jitter; })});
}

double average(const std::array<double, mapped_joints>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v / mapped_joints;
  return sum;
}

void add_noise(const Figures& real, const std::vector<Figures>& all, std::vector<Row>& rows) {
  rows.push_back(around("sd within a take, mean, cm", average(real.within), 0.10,
                        mean(all, [](const Figures& f) { return average(f.within); })));
  constexpr std::array<std::string_view, mapped_joints> sides{"",   "",   "",   "",   " L", " L",
                                                              " L", " R", " R", " R", " L", " L",
                                                              " L", " L", " R", " R", " R", " R"};
  for (std::size_t j = 0; j < mapped_joints; ++j) {
    rows.push_back(
        around(fmt::format("sd within a take, {}{}, cm", joint_rows[row_of[j]], sides[j]),
               real.within[j], 0.25, mean(all, [j](const Figures& f) { return f.within[j]; })));
  }
  constexpr std::array<double, 3> by{0.04, 0.08, 0.10};
  constexpr std::array<int, 3> lags{1, 5, 15};
  for (std::size_t l = 0; l < by.size(); ++l) {
    rows.push_back(give_or_take(fmt::format("autocorrelation at {} frames", lags[l]),
                                real.autocorrelation[l], by[l],
                                mean(all, [l](const Figures& f) { return f.autocorrelation[l]; })));
  }
  constexpr std::array<std::string_view, white_groups> groups{
      "trunk, shoulders, hips", "elbow, wrist", "knee", "ankle, foot"};
  for (std::size_t g = 0; g < white_groups; ++g) {
    for (std::size_t b = 0; b < speed_bins; ++b) {
      rows.push_back(around(fmt::format("white part, {}, {:g}–{:g} cm/s, mm", groups[g],
                                        100.0 * speed_edges[b], 100.0 * speed_edges[b + 1]),
                            real.white[g][b], 0.35,
                            mean(all, [g, b](const Figures& f) { return f.white[g][b]; })));
    }
  }
  for (std::size_t r = 0; r < joint_rows.size(); ++r) {
    rows.push_back(within_factor(
        fmt::format("residuals > 10 cm, {}, %", joint_rows[r]), 100.0 * real.far_off[r], 1.6,
        mean(all, [r](const Figures& f) { return 100.0 * f.far_off[r]; })));
  }
}

void add_cameras(const CameraFigures& found, std::vector<Row>& rows) {
  constexpr std::array<std::string_view, scenarios> names{"standing", "stepping",
                                                          "walking, turning"};
  constexpr std::array<std::array<double, rigs>, scenarios> rms{
      {{2.1, 4.1, 9.8}, {3.3, 5.6, 13.6}, {10.9, 13.5, 19.0}}};
  constexpr std::array<double, scenarios> share{0.30, 0.30, 0.35};
  for (std::size_t s = 0; s < scenarios; ++s) {
    for (std::size_t r = 0; r < rigs; ++r) {
      rows.push_back(around(fmt::format("two cameras, {}, {}°, rms cm", names[s], 45 * r),
                            rms[s][r], share[s], found.rms[s][r]));
    }
  }
  rows.push_back({"far elbow and wrist > 15 cm off, 90°, stepping, %", 47.0, 35.0, 60.0,
                  100.0 * found.far_arm});
  constexpr std::array<std::array<double, 3>, rigs> exchanged{
      {{0.0, 0.0, 0.1}, {0.3, 0.1, 0.8}, {4.0, 2.0, 7.0}}};
  for (std::size_t r = 0; r < rigs; ++r) {
    rows.push_back({fmt::format("whole body exchanged, {}°, % of frames", 45 * r), exchanged[r][0],
                    exchanged[r][1], exchanged[r][2], 100.0 * found.exchanged[r]});
  }
  constexpr std::array<double, scenarios> thigh{0.6, 4.7, 6.9};
  for (std::size_t s = 0; s < scenarios; ++s) {
    rows.push_back(around(fmt::format("sd of the thigh's length, {}, %", names[s]), thigh[s], 0.40,
                          found.thigh_sd[s]));
  }
}

void add_stamps(std::size_t seeds, std::vector<Row>& rows) {
  double mean_ms = 0.0, sd_ms = 0.0;
  for (std::size_t seed = 1; seed <= seeds; ++seed) {
    const StampFigures f = stamp_figures(seed);
    mean_ms += f.mean_ms / static_cast<double>(seeds);
    sd_ms += f.sd_ms / static_cast<double>(seeds);
  }
  rows.push_back(give_or_take("step of one frame, mean, ms", 33.33, 0.02, mean_ms));
  rows.push_back(give_or_take("step of one frame, sd, ms", 0.50, 0.05, sd_ms));
}

}  // namespace

Result<std::vector<Row>> measured_rows(const std::vector<Repetition>& real, std::size_t seeds,
                                       std::size_t jobs) {
  std::vector<Figures> all(seeds);
  parallel_for(seeds, jobs, [&](std::size_t i) { all[i] = figures(rehearsed(real, {}, i + 1)); });
  const Figures real_figures = figures(real);
  std::vector<Row> rows;
  add_marks(real_figures, all, rows);
  add_noise(real_figures, all, rows);
  for (Row& row : KA_TRY(camera_rows(seeds, jobs))) rows.push_back(std::move(row));
  return rows;
}

Result<std::vector<Row>> camera_rows(std::size_t seeds, std::size_t jobs) {
  std::vector<Row> rows;
  add_cameras(KA_TRY(median_camera_figures(1, seeds, jobs)), rows);
  add_stamps(seeds, rows);
  return rows;
}

std::string plain(const std::vector<Row>& rows) {
  std::string text;
  for (const Row& r : rows) {
    text += fmt::format("{:6} {:9.3f}  real {:8.3f}  band {:8.3f} to {:8.3f}  {}\n",
                        r.met() ? "met" : "MISSED", r.simulated, r.real, r.least, r.most, r.name);
  }
  const auto met = std::count_if(rows.begin(), rows.end(), [](const Row& r) { return r.met(); });
  return text + fmt::format("{} of {} bands met\n", met, rows.size());
}

std::string markdown(const std::vector<Row>& rows, std::size_t seeds) {
  std::string text = fmt::format(
      "<!-- made by kinalign_kinect_table --markdown --seeds {} -->\n\n"
      "| statistic | real | simulated | band | |\n| --- | --- | --- | --- | --- |\n",
      seeds);
  for (const Row& r : rows) {
    text += fmt::format("| {} | {:.3g} | {:.3g} | {:.3g} to {:.3g} | {} |\n", r.name, r.real,
                        r.simulated, r.least, r.most, r.met() ? "" : "missed");
  }
  const auto met = std::count_if(rows.begin(), rows.end(), [](const Row& r) { return r.met(); });
  return text +
         fmt::format("\n{} of {} bands met.\n\n<!-- end of what kinalign_kinect_table made -->\n",
                     met, rows.size());
}

}  // namespace kinalign
