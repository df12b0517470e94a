// SPDX-License-Identifier: Apache-2.0
// Chooses among several senders of one stream: the busiest one is the device, and a finding names
// the others. Any program can send a datagram to a port, and a device may return from another port
// of its own.
#pragma once

#include "kinalign/recording/streams/device_rows.h"
#include "kinalign/recording/survey.h"
#include "kinalign/wire/time.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The host of a sender: "192.168.7.20" for "192.168.7.20:51234".
std::string host_of(std::string_view sender);

/// Counts the messages of one stream's senders. The first and the last arrival of each show whether
/// two ports sent at the same time.
class SenderTable {
 public:
  /// Returns the number of a sender, given by address and port. A new sender gets a new number.
  std::size_t add(const std::string& sender);
  void count(std::size_t number, HostTime at);

  /// Addresses with at least one message, the one with the most messages first.
  std::vector<std::string> hosts() const;
  /// Completes a choice: by default the address with the most messages. Of its ports that send at
  /// the same time, only the one with the most messages is read. A device that returns from another
  /// port sends from one port after the other, and all are read.
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

/// Adds the names of all senders to an error: no rows could be made of the chosen one.
Error with_senders(Error error, const std::string& chosen, const SenderTable& senders);

/// Reports senders that are not read. `any_sender`: the user selected none.
Findings judge_senders(const DeviceRequest& request, bool any_sender, const SenderTable& senders);

/// Adds help to an error if the stream has several nodes and none was selected: lines for the
/// manifest that select one node, or all. Other errors are returned unchanged.
Error with_nodes(const DeviceRequest& request, const RecordingSurvey& survey, Error error);

}  // namespace kinalign
