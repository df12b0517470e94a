// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/pieces.h"

#include <algorithm>

namespace kinalign {

std::optional<std::size_t> Senders::number(const HostAddress& host, std::uint16_t port,
                                           HostTime now) {
  auto number = find(host, port);
  if (!number) number = add(host, port, now);
  if (number) note_arrival(*number, now);
  return number;
}

/// While the connection was silent, its number may have been given to another sender. The
/// connection then gets a new number.
std::optional<std::size_t> Senders::number(std::optional<Known>& known, const HostAddress& host,
                                           std::uint16_t port, HostTime now) {
  if (known && senders_[known->number].serial != known->serial) known.reset();
  if (!known) {
    const auto number = add(host, port, now);
    if (!number) return std::nullopt;
    known = {*number, senders_[*number].serial};
  }
  note_arrival(known->number, now);
  return known->number;
}

void Senders::note_arrival(std::size_t number, HostTime now) {
  senders_[number].last_arrival = now;
  ++senders_[number].times;
}

// Each serial number needs a channel, so their number is limited.
std::optional<std::size_t> Senders::add(const HostAddress& host, std::uint16_t port, HostTime now) {
  if (serials_ >= most_serials) {
    if (const auto past = own_past(host)) {
      // The sender of this host that was silent longest continues with the new port. It keeps its
      // number and its channel.
      senders_[*past].port = port;
      return past;
    }
  }
  const auto number = place_for(host, now);
  if (!number) return std::nullopt;
  serials_ = std::min(serials_ + 1, most_serials + 1);
  senders_[*number] = {host, port, now, serials_};
  return number;
}

/// Returns a free number, or the number of the sender that was silent longest. A number may be
/// reused after one minute of silence. Two seconds suffice in two cases: the sender sent few
/// messages, so it may be unrelated, or it has the host address of the new sender, so it is
/// probably the same device. If one host has at least half of all numbers, its senders of few
/// messages are replaced at once. A host that uses a new port for each message therefore displaces
/// only its own senders.
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
    const bool unrelated = sender.times < little, same_host = sender.host == host;
    Duration patience = std::chrono::minutes(1);
    if (unrelated || same_host) patience = std::chrono::seconds(2);
    if (unrelated && same_host && crowds) patience = Duration::zero();
    if (now - sender.last_arrival < patience) continue;
    if (!found || sender.last_arrival < senders_[*found].last_arrival) found = i;
  }
  return found;
}

/// Finds the sender of that host that was silent longest.
std::optional<std::size_t> Senders::own_past(const HostAddress& host) const {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < senders_.size(); ++i) {
    if (senders_[i].host != host) continue;
    if (!found || senders_[i].last_arrival < senders_[*found].last_arrival) found = i;
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
