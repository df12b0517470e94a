// SPDX-License-Identifier: Apache-2.0
// `pose --live`, `denoise --live` and `fuse --live`, from the connection to the last frame. Each
// returns what is to be said at the end, as the verb says it of a file, with latencies; `clip` gets
// all frames. Each fails where nobody serves, where the stream is none, and where no frame was
// answered.
#pragma once

#include "apps/kinalign/live/live_words.h"

#include "kinalign/models/live/live_cleaner.h"
#include "kinalign/models/live/live_fuser.h"
#include "kinalign/models/live/live_pose.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace kinalign {

/// Frames that an answer waits for where nobody says.
inline constexpr std::size_t usual_look_ahead = 2;

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

/// "live     9 ms after ...": the line that ends a live run, behind those of the verb.
std::string live_lines(const nlohmann::ordered_json& about);

}  // namespace kinalign
