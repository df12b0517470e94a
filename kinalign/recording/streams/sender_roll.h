// SPDX-License-Identifier: Apache-2.0
// Who spoke in a stream, how much, and who beside whom: anybody can send a datagram to a port, and
// a device may come back from another port of its own.
#pragma once

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

}  // namespace kinalign
