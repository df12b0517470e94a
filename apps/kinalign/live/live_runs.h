// SPDX-License-Identifier: Apache-2.0
// Runs `pose --live`, `denoise --live` and `fuse --live` from the connection to the last frame.
// Each function returns the JSON of a run on a file, with latencies added, and puts all frames into
// `clip`. Each fails if no server answers, if the stream does not come from `record`, or if no
// frame was answered.
#pragma once

#include "apps/kinalign/live/live_words.h"

#include "kinalign/models/live/live_cleaner.h"
#include "kinalign/models/live/live_fuser.h"
#include "kinalign/models/live/live_pose.h"

#include <nlohmann/json_fwd.hpp>

#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// The number of later frames that an answer waits for, unless --look-ahead states another one.
inline constexpr std::size_t usual_look_ahead = 2;

/// The settings of a live run. `pose` and `fuse` use `worn`; `denoise` and `fuse` use `kinect`.
struct LiveJob {
  LiveWords words;
  std::string nodes, kinect;  // names of streams; empty: the first that sends
  LiveWornOptions worn;

  std::size_t look_ahead() const {
    return static_cast<std::size_t>(words.look_ahead.value_or(usual_look_ahead));
  }
};

Result<nlohmann::ordered_json> run_live_pose(const PoseSolver& solver, const LiveJob& job,
                                             Clip& clip, Call& call);
Result<nlohmann::ordered_json> run_live_denoise(Denoiser& denoiser, const LiveJob& job, Clip& clip,
                                                Call& call);
Result<nlohmann::ordered_json> run_live_fuse(Fuser& fuser, const LiveJob& job, Clip& clip,
                                             Call& call);

/// A joint that is missing for a longer time gets a warning, in a live run and in a run on a file.
inline constexpr double longest_unseen_s = 2.0;
/// The warnings about missing joints. Joints that were missing for the same time share one warning.
/// `long_missing`: the time in seconds for each joint.
std::vector<std::string> missing_warnings(const nlohmann::ordered_json& long_missing);

/// The JSON member "found_headings": the corrections of the nodes' headings that were found with
/// the Kinect.
nlohmann::ordered_json headings_json(const std::vector<std::string>& nodes,
                                     std::span<const HeadingState> states);

/// The last line of a live run, printed after the verb's own lines: "live     9 ms after ...".
std::string live_lines(const nlohmann::ordered_json& about);

}  // namespace kinalign
