// SPDX-License-Identifier: Apache-2.0
// Texts about the senders and ports of a recording, used while recording and in a survey.
#pragma once

#include "kinalign/recording/survey.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// Returns the name of a sender for messages: "imu waist" or "imu 7" for a node, "mocap" for
/// another sender.
std::string sender_name(const std::string& stream, const std::string& node,
                        const std::string& place);
/// Returns the same name, with the place on the body that the recording states.
std::string sender_name(const std::string& stream, const std::string& node,
                        const RecordingSurvey& survey);
/// Returns text such as "mocap from 192.168.7.5:51234" or "imu waist from 192.168.7.21:4000".
std::string name_of(const CountedSender& sender, const RecordingSurvey& survey);

/// Returns text such as "1,234 dropped by the kernel"; empty if nothing was lost. `frames_lost`:
/// number of frames lost by all senders of that port, from their frame numbers.
std::string loss_of(const PortCounts& counts, std::uint64_t frames_lost);
/// Returns the number of frames that the senders of a device lost, from their frame numbers.
template <class Sender>
std::uint64_t frames_lost(const std::string& device, const std::vector<Sender>& senders) {
  std::uint64_t lost = 0;
  for (const Sender& sender : senders) {
    if (sender.stream == device) lost += sender.counts.order.lost;
  }
  return lost;
}

/// Returns text such as "181 datagrams came to port 6969, none a frame of nodes". It is for a
/// nodes' port that got datagrams, but none from a node. Empty if the port got none. `to`: "to port
/// 6969". The text distinguishes a wrong port or protocol from a device that is switched off.
std::string unusable_data(const PortCounts& counts, const std::string& to);

}  // namespace kinalign
