// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/pieces.h"

#include <algorithm>

namespace kinalign {

std::optional<std::size_t> Senders::number(const HostAddress& host, std::uint16_t port,
                                           HostTime now) {
  auto number = find(host, port);
  if (!number) number = add(host, port, now);
  if (number) hear(*number, now);
  return number;
}

/// Another may have got its number while it was silent; then it begins anew.
std::optional<std::size_t> Senders::number(std::optional<Known>& known, const HostAddress& host,
                                           std::uint16_t port, HostTime now) {
  if (known && senders_[known->number].life != known->life) known.reset();
  if (!known) {
    const auto number = add(host, port, now);
    if (!number) return std::nullopt;
    known = {*number, senders_[*number].life};
  }
  hear(known->number, now);
  return known->number;
}

void Senders::hear(std::size_t number, HostTime now) {
  senders_[number].heard = now;
  ++senders_[number].times;
}

std::optional<std::size_t> Senders::add(const HostAddress& host, std::uint16_t port, HostTime now) {
  if (lives_ >= most_lives) {
    if (const auto past = own_past(host)) {
      senders_[*past].port = port;
      return past;
    }
  }
  const auto number = place_for(host, now);
  if (!number) return std::nullopt;
  lives_ = std::min(lives_ + 1, most_lives + 1);
  senders_[*number] = {host, port, now, lives_};
  return number;
}

/// A new place, or that of the one who has been silent longest. Who said little was a stranger, who
/// comes from the newcomer's host likely the newcomer itself: two seconds are enough of them. Who
/// says everything from another port crowds out itself alone.
std::optional<std::size_t> Senders::place_for(const HostAddress& host, HostTime now) {
  if (senders_.size() < most) {
    senders_.emplace_back();
    return senders_.size() - 1;
  }
  const auto own = std::count_if(senders_.begin(), senders_.end(),
                                 [&](const Sender& sender) { return sender.host == host; });
  const bool crowds = 2 * static_cast<std::size_t>(own) >= most;
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < senders_.size(); ++i) {
    const Sender& sender = senders_[i];
    const bool stranger = sender.times < little, same_host = sender.host == host;
    Duration patience = std::chrono::minutes(1);
    if (stranger || same_host) patience = std::chrono::seconds(2);
    if (stranger && same_host && crowds) patience = Duration::zero();
    if (now - sender.heard < patience) continue;
    if (!found || sender.heard < senders_[*found].heard) found = i;
  }
  return found;
}

/// The one of that host that has been silent longest.
std::optional<std::size_t> Senders::own_past(const HostAddress& host) const {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < senders_.size(); ++i) {
    if (senders_[i].host != host) continue;
    if (!found || senders_[i].heard < senders_[*found].heard) found = i;
  }
  return found;
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
