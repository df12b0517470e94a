// SPDX-License-Identifier: Apache-2.0
#include "kinalign/take/recording.h"

#include <memory>
#include <utility>

namespace kinalign {

namespace {

StampSurvey survey(const std::vector<Time>& stamps) {
  StampSurveyor surveyor;
  surveyor.add(stamps);
  return surveyor.result();
}

/// All frames as the one block of each pass.
template <class Frames>
Passes<Frames> from_memory(Frames frames) {
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
RecordedStream stream(std::string name, const StampSurvey& survey, Input input) {
  RecordedStream out;
  out.name = std::move(name);
  out.survey = survey;
  out.data = std::move(input);
  return out;
}

}  // namespace

RecordedStream recorded(std::string name, Clip clip) {
  const StampSurvey found = survey(clip.frames.stamps);
  return stream(std::move(name), found,
                ClipInput{std::move(clip.skeleton), from_memory(std::move(clip.frames))});
}

RecordedStream recorded(std::string name, PointStream points) {
  const StampSurvey found = survey(points.frames.stamps);
  return stream(std::move(name), found,
                PointInput{std::move(points.joint_names), from_memory(std::move(points.frames))});
}

RecordedStream recorded(std::string name, ImuStream imu) {
  const StampSurvey found = survey(imu.samples.stamps);
  return stream(
      std::move(name), found,
      ImuInput{std::move(imu.node_names), imu.content, from_memory(std::move(imu.samples))});
}

}  // namespace kinalign
