// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/live/live_port.h"

#include "kinalign/capture/net/socket_address.h"
#include "kinalign/recording/format.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <cerrno>
#include <utility>

namespace kinalign {

namespace {

/// Makes the kernel send small messages immediately. Otherwise it waits for more data.
void send_at_once(int fd) {
  const int yes = 1;
  ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
}

}  // namespace

Result<LivePort> LivePort::open(std::uint16_t port, const McapHeader& header,
                                const std::vector<McapMetadata>& head) {
  Handle listener = KA_TRY(listen_tcp("127.0.0.1", port, most_clients));
  const std::uint16_t bound = bound_port(listener.fd());
  LivePort out(std::move(listener), bound);
  out.head_ = mcap_magic;
  append_mcap(out.head_, header);
  for (const McapMetadata& one : head) append_mcap(out.head_, one);
  return out;
}

void LivePort::accept() {
  for (;;) {
    Handle socket(::accept4(listener_.fd(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (socket.fd() < 0) return;
    if (clients_.size() == most_clients) {
      ++counts_.turned_away;
      continue;  // the destructor of `socket` closes the connection
    }
    send_at_once(socket.fd());
    ++counts_.clients;
    clients_.push_back({std::move(socket), head_});
  }
}

// Only whole messages are dropped for a slow client, so its stream stays valid.
void LivePort::add(const McapSchema* schema, const McapChannel& channel,
                   const McapMessage& message) {
  for (Client& client : clients_) {
    // The message number is then missing in this client's stream.
    if (client.waiting.size() - client.sent + message.data.size() > most_waiting) {
      ++counts_.lost;
      ++client.lost;
      continue;
    }
    if (!client.channels.contains(channel.id)) {
      if (schema != nullptr && client.schemas.insert(schema->id).second) {
        append_mcap(client.waiting, *schema);
      }
      append_mcap(client.waiting, channel);
      client.channels.insert(channel.id);
    }
    append_mcap(client.waiting, message);
  }
}

/// Returns whether the client has sent nothing. A client that sends data was meant for another
/// port.
bool LivePort::is_silent(const Client& client) {
  char byte = 0;
  const ssize_t got = ::recv(client.socket.fd(), &byte, 1, MSG_DONTWAIT);
  if (got > 0) ++counts_.turned_away;
  return got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
}

/// Sends waiting bytes. Returns false if the connection is broken.
bool LivePort::send(Client& client) {
  if (client.waiting.empty()) return true;
  const std::string_view rest = std::string_view(client.waiting).substr(client.sent);
  const ssize_t sent =
      ::send(client.socket.fd(), rest.data(), rest.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  if (sent < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
  client.sent += static_cast<std::size_t>(sent);
  // Sent bytes are erased only when they are at least half of the buffer, so that moving the rest
  // costs no more than sending did.
  if (2 * client.sent < client.waiting.size()) return true;
  client.waiting.erase(0, client.sent);
  client.sent = 0;
  return true;
}

// Each loop of the recording calls this, so a client waits at most one loop.
void LivePort::turn() {
  accept();
  std::erase_if(clients_, [this](Client& client) { return !is_silent(client) || !send(client); });
}

// The end record states how many messages were dropped for the client.
void LivePort::end() {
  for (Client& client : clients_) {
    append_mcap(client.waiting, to_metadata(RecordingEnd{client.lost}));
    append_mcap(client.waiting, McapDataEnd{});
    append_mcap(client.waiting, McapFooter{});
    client.waiting += mcap_magic;
    (void)send(client);
  }
  clients_.clear();
}

}  // namespace kinalign
