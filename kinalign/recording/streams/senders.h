// SPDX-License-Identifier: Apache-2.0
// Chooses among several senders of one stream: which of them is the device, and what is reported
// about the others. Any program can send a datagram to a port, and a device may return from another
// port of its own.
#pragma once

#include "kinalign/recording/streams/device_rows.h"
#include "kinalign/recording/survey.h"
#include "kinalign/wire/time.h"

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The host of a sender: "192.168.7.20" for "192.168.7.20:51234".
std::string host_of(std::string_view sender);

/// The senders of one stream with the numbers of their messages.
class SenderRoll {
 public:
  /// Returns the number of a sender, given by address and port. A new sender gets a new number.
  std::size_t add(const std::string& sender);
  /// Counts a message of a sender. Call in the order of arrival.
  void hear(std::size_t number, HostTime at);

  /// Addresses with at least one message, the one with the most messages first.
  std::vector<std::string> hosts() const;
  /// Senders at an address that sent at the same time as a more active one. A device that returns
  /// from another port sends after its earlier self, not at the same time, so it is not included.
  std::set<std::string> beside(std::string_view host) const;
  /// The senders at an address, the one with the most messages first.
  std::vector<std::string> senders(std::string_view host) const;

 private:
  struct Sender {
    std::string name, host;
    std::uint64_t messages = 0;
    HostTime last{};
    // by sender: how often that sender's messages stood between two of this one
    std::map<std::size_t, std::uint64_t> between{};
  };
  std::vector<std::size_t> of_host(std::string_view host) const;
  bool is_beside(std::size_t a, std::size_t b) const;

  std::vector<Sender> senders_;
  std::map<std::string, std::size_t, std::less<>> numbers_;
  // the last active sender of each address
  std::map<std::string, std::size_t, std::less<>> speaking_;
};

/// The devices to try, in this order, until rows can be made of one. Addresses with the most
/// messages come first. Senders that sent at the same time as a more active one of their address
/// are left out.
std::vector<DeviceChoice> choices(const DeviceChoice& wished, const SenderRoll& senders);

/// Adds the names of all senders to an error: no rows could be made of the chosen one.
Error with_senders(Error error, const std::string& chosen, const SenderRoll& senders);

/// Adds help to an error if the stream has several nodes and none was selected: lines for the
/// manifest that select one node, or all. Other errors are returned unchanged.
Error with_nodes(const DeviceWish& wish, const RecordingSurvey& survey, Error error);

/// Reports senders that are not read. `any_sender`: the user selected none.
Findings judge_senders(const DeviceWish& wish, bool any_sender, const SenderRoll& senders);

}  // namespace kinalign
