// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/pieces.h"

#include <algorithm>

namespace kinalign {

std::optional<std::size_t> Senders::number(const HostAddress& host, std::uint16_t port,
                                           HostTime now) {
  constexpr Duration silence = std::chrono::minutes(1);
  auto found = std::find_if(senders_.begin(), senders_.end(), [&](const Sender& sender) {
    return sender.host == host && sender.port == port;
  });
  if (found == senders_.end() && senders_.size() < most) {
    found = senders_.insert(found, {host, port, now, ++lives_});
  } else if (found == senders_.end()) {
    found = std::min_element(senders_.begin(), senders_.end(),
                             [](const Sender& a, const Sender& b) { return a.heard < b.heard; });
    if (now - found->heard < silence) return std::nullopt;
    *found = {host, port, now, ++lives_};
  }
  found->heard = now;
  return static_cast<std::size_t>(found - senders_.begin());
}

std::optional<std::size_t> Senders::find(const HostAddress& host, std::uint16_t port) const {
  const auto found = std::find_if(senders_.begin(), senders_.end(), [&](const Sender& sender) {
    return sender.host == host && sender.port == port;
  });
  if (found == senders_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - senders_.begin());
}

void Senders::remember(std::size_t number, const Datagram& asked) {
  senders_[number].asked = asked;
  senders_[number].asked.bytes = {};
}

}  // namespace kinalign
