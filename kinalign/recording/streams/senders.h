// SPDX-License-Identifier: Apache-2.0
// Chooses among several senders of one stream. The busiest sender is the device, and a finding
// names the others. Any program can send a datagram to a port. A device that reconnects may use
// another port.
#pragma once

#include "kinalign/recording/streams/device_rows.h"
#include "kinalign/recording/survey.h"
#include "kinalign/wire/time.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The host of a sender, for example "192.168.7.20" for "192.168.7.20:51234".
std::string host_of(std::string_view sender);

/// Counts the messages of one stream's senders. The first and last arrival of each sender show
/// whether two ports sent at the same time.
class SenderTable {
 public:
  /// Returns the index of a sender, which is given by address and port. A new sender gets a new
  /// index.
  std::size_t add(const std::string& sender);
  void count(std::size_t number, HostTime at);

  /// The hosts with at least one message, sorted by the number of messages, highest first.
  std::vector<std::string> hosts() const;
  /// Completes a choice. The default is the host with the most messages. If several of its ports
  /// sent at the same time, only the busiest port is read. If the ports sent one after the other,
  /// they are one device that reconnected, and all are read.
  void complete(DeviceChoice& choice) const;

 private:
  struct Sender {
    std::string name;
    std::uint64_t messages = 0;
    HostTime first{}, last{};
  };
  static bool overlap(const Sender& a, const Sender& b);

  std::vector<Sender> senders_;
};

/// Adds the names of all senders to the error that the chosen sender gives no rows.
Error with_senders(Error error, const std::string& chosen, const SenderTable& senders);

/// Adds findings about senders that are not read. `any_sender`: the user selected no sender.
Findings judge_senders(const DeviceRequest& request, bool any_sender, const SenderTable& senders);

/// Adds advice to an error if the stream has several nodes and the user selected none. The advice
/// consists of lines for the manifest that select one node, or all nodes. Other errors are returned
/// unchanged.
Error with_nodes(const DeviceRequest& request, const RecordingSurvey& survey, Error error);

}  // namespace kinalign
