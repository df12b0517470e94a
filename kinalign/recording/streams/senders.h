// SPDX-License-Identifier: Apache-2.0
// Several senders of one stream: who sent how much and at whose side, which of them is the device,
// and what is told of the others. Anybody can send a datagram to a port, and a device may come back
// from another port of its own.
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

/// "192.168.7.20" of "192.168.7.20:51234".
std::string host_of(std::string_view sender);

class SenderRoll {
 public:
  /// The number of a sender, an address with its port; a new one where it was not added before.
  std::size_t add(const std::string& sender);
  /// A message of this one; in the order of arrival.
  void hear(std::size_t number, HostTime at);

  /// Addresses of which anything was heard, the one with the most messages first.
  std::vector<std::string> hosts() const;
  /// Of an address: senders that spoke in turn with one that said more. Who comes back from another
  /// port speaks behind the one before, not beside it.
  std::set<std::string> beside(std::string_view host) const;
  /// The address's senders, the one with the most messages first.
  std::vector<std::string> senders(std::string_view host) const;

 private:
  struct Sender {
    std::string name, host;
    std::uint64_t messages = 0;
    HostTime last{};
    std::map<std::size_t, std::uint64_t> between{};  // its messages: others' that stood in between
  };
  std::vector<std::size_t> of_host(std::string_view host) const;
  bool is_beside(std::size_t a, std::size_t b) const;

  std::vector<Sender> senders_;
  std::map<std::string, std::size_t, std::less<>> numbers_;
  std::map<std::string, std::size_t, std::less<>> speaking_;  // who spoke last, by address
};

/// Whom to listen to, in this order until rows can be made of one: those with most messages come
/// first, of an address without those that speak beside a busier one.
std::vector<DeviceChoice> choices(const DeviceChoice& wished, const SenderRoll& senders);

/// Of the chosen one no rows could be made: with the names of all.
Error with_senders(Error error, const std::string& chosen, const SenderRoll& senders);

/// A recording has several nodes of the stream and none was asked for: with lines of a manifest
/// that ask for one, or for all. Any other error as it is.
Error with_nodes(const DeviceWish& wish, const RecordingSurvey& survey, Error error);

/// That there are others than the ones that are read. `any_sender`: nobody asked for one.
Findings judge_senders(const DeviceWish& wish, bool any_sender, const SenderRoll& senders);

}  // namespace kinalign
