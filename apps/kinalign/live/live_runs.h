// SPDX-License-Identifier: Apache-2.0
// `pose --live`, `denoise --live` and `fuse --live`, from the connection to the last frame. Each
// returns the JSON that the verb has for a file, with latencies; `clip` gets all frames. Each fails
// if no server answers, if the stream is not one of record, or if no frame was answered.
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

/// The frames that an answer waits for without --look-ahead.
inline constexpr std::size_t usual_look_ahead = 2;

/// The words of one live run. `worn` is used by pose and fuse, `kinect` by denoise and fuse.
struct LiveJob {
  LiveWords words;
  std::string nodes, kinect;  // streams; empty: the first that sends any
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

/// A joint missing for longer gets a warning, in a live run and in a file.
inline constexpr double longest_unseen_s = 2.0;
/// One warning for all joints that were missing for the same time. `long_missing`: s, by the joint.
std::vector<std::string> missing_warnings(const nlohmann::ordered_json& long_missing);

/// The corrections of the nodes' headings by the Kinect: the member "found_headings".
nlohmann::ordered_json headings_json(const std::vector<std::string>& nodes,
                                     std::span<const HeadingState> states);

/// The last line of a live run, after those of the verb: "live     9 ms after ...".
std::string live_lines(const nlohmann::ordered_json& about);

}  // namespace kinalign
