// SPDX-License-Identifier: Apache-2.0
// Words about the senders and ports of a recording, the same while recording and in a survey.
#pragma once

#include "kinalign/recording/survey.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// The name of a sender for people: "imu waist", "imu 7"; "mocap" for a sender that is no node.
std::string sender_name(const std::string& stream, const std::string& node,
                        const std::string& place);
/// The same, with the place that the recording states.
std::string sender_name(const std::string& stream, const std::string& node,
                        const RecordingSurvey& survey);
/// "mocap from 192.168.7.5:51234", "imu waist from 192.168.7.21:4000"
std::string name_of(const CountedSender& sender, const RecordingSurvey& survey);

/// "1,234 dropped by the kernel". Empty if nothing was lost. `frames_lost`: the frames lost by the
/// numbers of all senders of that port.
std::string loss_of(const PortCounts& counts, std::uint64_t frames_lost);
/// The frames that a device's senders lost, by their own numbers.
template <class Sender>
std::uint64_t frames_lost(const std::string& device, const std::vector<Sender>& senders) {
  std::uint64_t lost = 0;
  for (const Sender& sender : senders) {
    if (sender.stream == device) lost += sender.counts.order.lost;
  }
  return lost;
}

/// "181 datagrams came to port 6969, none a frame of nodes": for a nodes' port to which something
/// came, though no node has sent. Empty if nothing came. `to`: "to port 6969".
/// It tells a wrong port or protocol from a device that is switched off.
std::string unusable_data(const PortCounts& counts, const std::string& to);

}  // namespace kinalign
