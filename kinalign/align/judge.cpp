// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace kinalign {

namespace {

/// Returns the part of the clock offset that start_ns caused. Only streams of several files have
/// such a part. A single file uses start_ns as the stamp of its first row and needs no offset.
Duration own_offset(const RecordedStream& s, const StreamOptions& options) {
  return s.clock.pieces.front().offset - Duration{std::llround(options.offset_ms * 1e6)};
}

/// Returns the name of the stream's file, or the stream's name if it comes from memory.
std::string file_of(const RecordedStream& s) {
  return s.files.empty() ? s.name : s.files.front().name;
}

/// The steps between the accepted samples of a device that stamps its samples, ns.
struct Steps {
  double median = 0.0, mean = 0.0;
  std::uint64_t long_ones = 0;
  double long_share = 0.0;  // share of the stream's time that is in long steps
};

/// Computes the steps. The result is absent for counted stamps, which are always regular, and for
/// too few samples.
std::optional<Steps> steps_of(const RecordedStream& s) {
  constexpr std::uint64_t enough = 10;
  const StampSurvey& survey = s.survey;
  if (s.counted || survey.kept() < enough || survey.median_step_ns == 0) return std::nullopt;
  const double all = static_cast<double>(to_ns(survey.last) - to_ns(survey.first));
  // The mean includes pauses, the median does not. A large ratio means that the device pauses or
  // sends in bursts.
  return Steps{static_cast<double>(survey.median_step_ns),
               all / static_cast<double>(survey.kept() - 1), survey.long_steps,
               static_cast<double>(survey.long_time_ns) / all};
}

/// Warns if the unit of the stamps is probably wrong. A wrong unit changes the rate by a factor of
/// at least 1000 (100 for .NET ticks). The resulting rates are impossible: cameras reach 1,000
/// frames per second, inertial sensors 2,000 samples.
void judge_unit(const Steps& steps, const RecordedStream& s, FileFindings& out) {
  const double fastest_hz = std::holds_alternative<ImuInput>(s.data) ? 2500.0 : 1200.0;
  constexpr double slowest_hz = 0.5;
  const double rate = 1e9 / steps.median;
  if (rate <= fastest_hz && rate >= slowest_hz) return;
  out.add(
      Severity::warning, fmt::format("{} to {} samples per second", slowest_hz, fastest_hz),
      fmt::format("{:.4g} according to the stamps", rate),
      "the stamps were probably read in the wrong unit",
      "if a layout reads the stamps, correct the unit in its [time]: ns, us, ms, s or ticks_100ns");
}

/// Warns if the stated rate differs from both the median step and the mean step. If a device sends
/// in bursts, only the mean step is right.
void judge_stated(const Steps& steps, double nominal_hz, FileFindings& out) {
  // A step agrees with the stated rate if they differ by less than this factor.
  constexpr double alike = 1.5;
  const auto fits = [nominal_hz](double step) {
    return step < alike * 1e9 / nominal_hz && alike * step > 1e9 / nominal_hz;
  };
  if (fits(steps.median) || fits(steps.mean)) return;
  out.add(Severity::warning,
          fmt::format("steps of {:.3g} ms, as stated by rate_hz", 1e3 / nominal_hz),
          fmt::format("a median of {:.3g} ms", 1e-6 * steps.median),
          "gaps and invalid samples are judged by the wrong rate",
          fmt::format("set rate_hz = {:.3g}, or remove it", 1e9 / steps.median));
}

/// Warns if a stream has no samples for more than half of its time. Either the device paused, or
/// samples came in bursts and were stamped on arrival. The stamps can't show which of the two is
/// true. Ten trials have nine pauses between them, so up to `pauses` long steps give no warning.
void judge_rate(const Steps& steps, FileFindings& out) {
  constexpr double gap_steps = 3.0, burst = 5.0, alike = 1.5;
  constexpr std::uint64_t pauses = 10;
  if (steps.long_ones <= pauses || steps.long_share < 0.5 || steps.mean < alike * steps.median) {
    return;
  }
  // The mean step includes all time, so it gives the rate if samples came in bursts.
  const double from_mean = 1e9 / steps.mean;
  std::string found, meaning, repair;
  if (steps.mean < burst * steps.median) {
    found = fmt::format("a mean of {:.3g} ms", 1e-6 * steps.mean);
    meaning = "stretches longer than three median steps count as gaps";
    repair = fmt::format(
        "if the device sends this way, set rate_hz = {:.3g} or gap_ms = {:.3g}; otherwise many "
        "samples are missing",
        from_mean, gap_steps * 1e-6 * steps.mean);
  } else {
    found = fmt::format("{} longer steps, {:.0f} % of the time", steps.long_ones,
                        100.0 * steps.long_share);
    meaning = "the device paused, or samples came in bursts and were stamped on arrival";
    repair = fmt::format(
        "if the device paused, set rate_hz = {:.3g}; if samples came in bursts, remove the time "
        "column from the layout and set rate_hz = {:.3g}",
        1e9 / steps.median, from_mean);
  }
  out.add(Severity::warning,
          fmt::format("steps near their median of {:.3g} ms", 1e-6 * steps.median), found, meaning,
          repair);
}

}  // namespace

/// Judges the stamps by the counts of the survey. No sample is read.
Findings judge_stamps(const RecordedStream& s, const StreamOptions& options) {
  FileFindings out{file_of(s)};
  // A few samples are sometimes sent twice. Many duplicates have another cause.
  const bool often = s.survey.duplicates > 10 && 20 * s.survey.duplicates > s.survey.samples;
  if (s.survey.duplicates > 0) {
    out.add(often ? Severity::warning : Severity::note, "rising stamps",
            fmt::format("{} that repeat the previous stamp", s.survey.duplicates),
            "these samples were left out",
            often ? "the stamps are rounded, or one file contains rows of several nodes" : "");
  }
  if (s.survey.ahead > 0) {
    out.add(Severity::warning, "stamps without jumps",
            fmt::format("{} far ahead of their neighbours", s.survey.ahead),
            "these samples were left out");
  }
  if (s.survey.backward > 0) {
    // After a clock was set back, all following stamps are before earlier ones, so their number is
    // large.
    const bool many = 20 * s.survey.backward > s.survey.samples;
    out.add(
        many ? Severity::error : Severity::warning, "rising stamps",
        fmt::format("{} of {} that step back, by up to {:.3f} s", s.survey.backward,
                    s.survey.samples, 1e-9 * static_cast<double>(s.survey.largest_step_back_ns)),
        "these samples were left out",
        many ? "the device's clock was set back: cut the file there, or remove the time "
               "column from its layout and set rate_hz"
             : "if there are many, check the device's clock");
  }
  if (const auto steps = steps_of(s)) {
    judge_unit(*steps, s, out);
    if (options.rate_hz > 0.0) {
      judge_stated(*steps, options.rate_hz, out);
    } else {
      judge_rate(*steps, out);
    }
  }
  return out.all;
}

/// The severity depends on the effect. Dropped or late samples change the take; an irregular step
/// only prevents their detection.
Findings judge_arrivals(const RecordedStream& s, const Arrivals& arrivals, Role role) {
  FileFindings out{file_of(s)};
  if (arrivals.near > 0) {
    const std::string what = role == Role::reference
                                 ? "this stream is the reference, so they keep their late stamps, "
                                   "and the other streams are resampled onto them"
                                 : "they are dropped when the stream is resampled";
    out.add(Severity::warning, "samples at least a fifth of a step apart",
            fmt::format("{} closer to the next sample", arrivals.near),
            "these samples were delayed: " + what,
            "stamp samples when they are measured, not when they arrive");
  }
  if (arrivals.late > 0) {
    out.add(Severity::warning, "samples without delay",
            fmt::format("{} in a burst after a pause, late by {:.2f} s or more", arrivals.late,
                        1e-9 * static_cast<double>(arrivals.worst_late_ns)),
            "where these samples are used, the take lags behind the motion by this time",
            "use the device's own stamps if the file has them, or remove the time column from its "
            "layout and set rate_hz");
  }
  if (arrivals.near_only) {
    out.add(Severity::note, "a regular step, to detect late samples",
            fmt::format("a median of {:.4g} ms, a mean of {:.4g}",
                        1e-6 * static_cast<double>(s.survey.median_step_ns),
                        1e-6 * static_cast<double>(s.survey.usual_step_ns)),
            "late samples were not looked for",
            "set rate_hz to the device's true rate, or use finer stamps");
  }
  return out.all;
}

/// Findings name a file. If several streams read the file, the name of the stream is added.
Findings with_stream_name(const RecordedStream& stream, const Recording& recording,
                          Findings findings) {
  const auto reads_the_same = [&](const RecordedStream& other) {
    return &other != &stream && file_of(other) == file_of(stream);
  };
  const auto& streams = recording.streams;
  if (std::none_of(streams.begin(), streams.end(), reads_the_same)) return findings;
  for (Finding& finding : findings) {
    finding.what.expected = fmt::format("{} in '{}'", finding.what.expected, stream_label(stream));
  }
  return findings;
}

/// start_ns is the stamp of the first row. If that row is dropped or late, the whole stream is
/// shifted by the error.
Findings judge_start(const RecordedStream& s, const StreamOptions& options,
                     const Arrivals& arrivals) {
  if (s.counted || !options.start_ns) return {};
  // With several files, the earliest accepted sample has the stamp start_ns.
  const bool several = options.files.size() > 1;
  const Time start = utc_time(*options.start_ns);
  if (several && s.survey.first + own_offset(s, options) != start) return {};
  const bool first_kept = several || s.survey.first == start;
  if (first_kept && !arrivals.first_late) return {};
  FileFindings out{file_of(s)};
  out.add(Severity::warning, "a first sample that was stamped when it was measured, for start_ns",
          first_kept ? "a delayed sample" : "a sample whose stamp is far from the others",
          "the whole stream is shifted by this delay",
          "remove this sample from the file, and set start_ns to the stamp of the next sample");
  return out.all;
}

Findings judge_content(const RecordedStream& s, const ResampleCount& count, double grid_hz) {
  // Below these limits, the noise of a stream can't be distinguished from motion. Chosen values:
  // Kinect v2 joints at rest move by 0.1 to 0.9 mm, hand tips by 2.5 mm (measured on
  // KinectMultiTrack). Inertial sensors of phones and trackers have about 0.02 m/s2 and 0.005
  // rad/s.
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
