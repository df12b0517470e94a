// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinalign/recording/survey.h"

namespace kinalign {

/// The survey of a whole recording of one Kinect: messages that were counted, are in the file, and
/// are missing between two others.
inline RecordingSurvey kinect_survey(std::uint64_t counted, std::uint64_t present,
                                     std::uint64_t missing) {
  RecordingSurvey survey;
  survey.facts.emplace();
  survey.facts->part = 1;
  survey.end = RecordingEnd{};
  survey.ending = Ending::ended;
  ChannelSurvey channel;
  channel.channel.topic = "/kinect/raw";
  channel.messages = present;
  channel.missing = missing;
  survey.channels.push_back(channel);
  CountedSender sender;
  sender.topic = "/kinect/raw";
  sender.stream = "kinect";
  sender.counts.messages = counted;
  survey.senders.push_back(sender);
  return survey;
}

}  // namespace kinalign
