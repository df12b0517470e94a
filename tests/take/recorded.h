// SPDX-License-Identifier: Apache-2.0
// Recorded streams from memory. Their stamps are surveyed as those of files are.
#pragma once

#include "kinalign/take/recording.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

inline StampSurvey survey_of_stamps(const std::vector<Time>& stamps) {
  StampSurveyor surveyor;
  surveyor.add(stamps);
  return surveyor.result();
}

/// Passes over frames in memory; each pass has all frames in one block.
template <class Frames>
Passes<Frames> from_memory(Frames frames) {
  // All passes share one copy of the frames.
  return [all = std::make_shared<const Frames>(std::move(frames))]() -> Result<Pass<Frames>> {
    return Pass<Frames>([all, done = false](Frames& block) mutable -> Result<bool> {
      if (done || all->stamps.empty()) return false;
      block = *all;
      done = true;
      return true;
    });
  };
}

template <class Input>
RecordedStream stream_in_memory(std::string name, const StampSurvey& survey, Input input) {
  RecordedStream out;
  out.name = std::move(name);
  out.survey = survey;
  out.data = std::move(input);
  return out;
}

inline RecordedStream recorded(std::string name, Clip clip) {
  const StampSurvey found = survey_of_stamps(clip.frames.stamps);
  return stream_in_memory(std::move(name), found,
                          ClipInput{std::move(clip.skeleton), from_memory(std::move(clip.frames))});
}

inline RecordedStream recorded(std::string name, PointStream points) {
  const StampSurvey found = survey_of_stamps(points.frames.stamps);
  return stream_in_memory(
      std::move(name), found,
      PointInput{std::move(points.joint_names), from_memory(std::move(points.frames))});
}

inline RecordedStream recorded(std::string name, ImuStream imu) {
  const StampSurvey found = survey_of_stamps(imu.samples.stamps);
  return stream_in_memory(
      std::move(name), found,
      ImuInput{std::move(imu.node_names), imu.content, from_memory(std::move(imu.samples))});
}

}  // namespace kinalign
