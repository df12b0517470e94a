// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace kinalign {

namespace {

std::string file_of(const RecordedStream& s) {
  return s.files.empty() ? s.name : s.files.front().name;
}

/// Steps between the samples kept of a device that stamps them, ns.
struct Steps {
  double median = 0.0, mean = 0.0;
  bool often_long = false;  // one in ten and more: the device's way, and no pause now and then
};

std::optional<Steps> steps_of(const RecordedStream& s) {
  constexpr std::uint64_t enough = 10;
  const StampSurvey& survey = s.survey;
  if (s.counted || survey.kept() < enough || survey.median_step_ns == 0) return std::nullopt;
  return Steps{static_cast<double>(survey.median_step_ns),
               static_cast<double>(to_ns(survey.last) - to_ns(survey.first)) /
                   static_cast<double>(survey.kept() - 1),
               10 * survey.long_steps >= survey.kept() - 1};
}

/// A unit taken for another is wrong by a thousand or more, .NET's ticks by a hundred: no device of
/// the field is so quick or so slow.
Findings judge_unit(const Steps& steps, const std::string& file) {
  constexpr double fastest_hz = 1200.0, slowest_hz = 0.5;
  const double rate = 1e9 / steps.median;
  if (rate <= fastest_hz && rate >= slowest_hz) return {};
  return {{Severity::warning,
           Error{file, 0, fmt::format("{} to {} samples a second", slowest_hz, fastest_hz),
                 fmt::format("{:.4g} by the stamps", rate)},
           "the stamps may be in another unit than they were read in",
           "where a layout reads them, its [time] says the column's unit: ns, us, ms, s or "
           "ticks_100ns"}};
}

/// The median tells a device's period, but not where samples come in bursts. A few long steps are
/// gaps, which the report counts.
Findings judge_rate(const Steps& steps, double nominal_hz, const std::string& file) {
  constexpr double gap_steps = 3.0, burst = 5.0, alike = 1.5;
  const double from_mean = 1e9 / steps.mean;
  const std::string found = fmt::format("a mean of {:.3g} ms", 1e-6 * steps.mean);
  const auto warning = [&](std::string expected, std::string said, std::string meaning,
                           std::string repair) -> Findings {
    return {{Severity::warning, Error{file, 0, std::move(expected), std::move(said)},
             std::move(meaning), std::move(repair)}};
  };
  const std::string median =
      fmt::format("steps near their median of {:.3g} ms", 1e-6 * steps.median);
  if (steps.often_long && steps.mean > burst * steps.median) {
    return warning(
        median, found, "the stamps are of arrival, in bursts",
        fmt::format("where a layout reads them, leave its time column out and say rate_hz = "
                    "{:.3g}",
                    from_mean));
  }
  if (nominal_hz > 0.0) {
    const auto fits = [nominal_hz](double step) {
      return step < alike * 1e9 / nominal_hz && alike * step > 1e9 / nominal_hz;
    };
    if (fits(steps.median) || fits(steps.mean)) return {};
    return warning(fmt::format("steps of {:.3g} ms, by rate_hz", 1e3 / nominal_hz),
                   fmt::format("a median of {:.3g} ms", 1e-6 * steps.median),
                   "gaps and invalid samples are told by the wrong rate",
                   fmt::format("say rate_hz = {:.3g}, or nothing", 1e9 / steps.median));
  }
  if (!steps.often_long || steps.mean < alike * steps.median) return {};
  return warning(median, found, "stretches longer than three median steps are taken for gaps",
                 fmt::format("where that is the device's way, say rate_hz = {:.3g} or gap_ms = "
                             "{:.3g}; else many are missing",
                             from_mean, gap_steps * 1e-6 * steps.mean));
}

}  // namespace

Findings judge_stamps(const RecordedStream& s, const StreamOptions& options) {
  Findings out;
  const std::string file = file_of(s);
  // A sample now and then is sent twice; of many, something else is the reason.
  const bool often = s.survey.duplicates > 10 && 20 * s.survey.duplicates > s.survey.samples;
  if (s.survey.duplicates > 0) {
    out.push_back({often ? Severity::warning : Severity::note,
                   Error{file, 0, "stamps that rise",
                         fmt::format("{} that repeat the one before", s.survey.duplicates)},
                   "these samples were left out",
                   often ? "stamps that are rounded, or rows of several nodes in one file" : ""});
  }
  if (s.survey.ahead > 0) {
    out.push_back({Severity::warning,
                   Error{file, 0, "stamps that go on from one another",
                         fmt::format("{} far ahead of the ones around", s.survey.ahead)},
                   "these samples were left out", ""});
  }
  if (s.survey.backward > 0) {
    // Behind a clock that was set back nothing is later than what came before.
    const bool many = 20 * s.survey.backward > s.survey.samples;
    out.push_back(
        {many ? Severity::error : Severity::warning,
         Error{file, 0, "stamps that rise",
               fmt::format("{} of {} that step back, by up to {:.3f} s", s.survey.backward,
                           s.survey.samples,
                           1e-9 * static_cast<double>(s.survey.largest_step_back_ns))},
         "these samples were left out",
         many ? "the device's clock was set back: cut the file there, or stamp it by rate_hz"
              : "look at the device's clock if there are many"});
  }
  if (const auto steps = steps_of(s)) {
    append(out, judge_unit(*steps, file));
    append(out, judge_rate(*steps, options.rate_hz, file));
  }
  return out;
}

Findings judge_near(const RecordedStream& s, std::uint64_t near, Role role) {
  if (near == 0) return {};
  const char* then = role == Role::reference
                         ? "as the reference they keep the stamp of their arrival, at which the "
                           "other streams are taken"
                         : "they are left out where the stream is resampled";
  return {{Severity::warning,
           Error{file_of(s), 0, "samples a fifth of a step or more apart",
                 fmt::format("{} with the next one nearer: held back on their way", near)},
           then, "stamp samples where they are taken, not where they arrive"}};
}

Findings judge_content(const RecordedStream& s, const ResampleCount& count, double grid_hz) {
  // Below these a stream's own noise looks like content. Chosen: Kinect v2 joints at rest wander by
  // 0.1 to 0.9 mm, hand tips by 2.5 (measured on KinectMultiTrack); inertial sensors of phones and
  // trackers by some 0.02 m/s2 and 0.005 rad/s.
  constexpr double points_m = 0.002, acceleration_m_s2 = 0.05, angular_velocity_rad_s = 0.01;
  Findings out;
  const auto add = [&](const std::vector<CarriedContent>& contents, const std::string& quantity,
                       const std::vector<std::string>& parts, double noise) {
    append(out, judge_carried(contents, {s.name, quantity, parts, grid_hz, noise}));
  };
  if (const auto* points = std::get_if<PointInput>(&s.data)) {
    add(count.positions, "position", points->joint_names, points_m);
  } else if (const auto* imu = std::get_if<ImuInput>(&s.data)) {
    add(count.acceleration, "acceleration", imu->node_names, acceleration_m_s2);
    add(count.angular_velocity, "angular velocity", imu->node_names, angular_velocity_rad_s);
  }
  return out;
}

}  // namespace kinalign
