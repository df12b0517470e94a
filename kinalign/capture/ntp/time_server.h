// SPDX-License-Identifier: Apache-2.0
// The NTP server: the sockets and an NtpResponder. One thread serves all sockets. It waits only
// while no datagram has arrived.
#pragma once

#include "kinalign/capture/net/datagram_batch.h"
#include "kinalign/capture/net/udp_socket.h"
#include "kinalign/capture/nodes/node_receiver.h"
#include "kinalign/capture/ntp/chrony_query.h"
#include "kinalign/capture/ntp/clock_state.h"
#include "kinalign/capture/ntp/ntp_responder.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// Choices of the user, except `key`, which the program draws.
struct TimeServerOptions {
  std::vector<std::string> addresses;         // addresses to serve on; empty: all of IPv4 and IPv6
  std::uint16_t port = 123;                   // 0: any free port, the same for all addresses
  std::optional<std::uint8_t> local_stratum;  // see ClockPolicy
  std::vector<AddressBlock> exempt;           // networks whose requests are not limited
  SipHashKey key{};                           // random in each run
  std::uint16_t chrony_port = 323;            // command port of this host's chronyd
};

/// The server answers requests. It never sets a clock.
class TimeServer {
 public:
  static Result<TimeServer> open(const TimeServerOptions& options);

  /// Serves until `go_on` returns false. `go_on` is called four times a second, and immediately
  /// after a signal. If `nodes` is given, the same thread serves the nodes' port, before the NTP
  /// sockets.
  void serve(const std::function<bool()>& go_on, NodeReceiver* nodes = nullptr);

  const std::vector<UdpSocket>& sockets() const { return sockets_; }
  const NtpServerState& state() const { return responder_.state(); }
  const NtpCounts& counts() const { return counts_; }

 private:
  TimeServer(const TimeServerOptions& options, std::vector<UdpSocket> sockets);
  void look_at_clock();
  void serve_until(HostTime end);
  void drain(const UdpSocket& socket);
  void answer(const UdpSocket& socket, std::size_t datagrams);

  ClockPolicy policy_;
  ChronyQuery chrony_;
  std::vector<UdpSocket> sockets_;
  NtpResponder responder_;
  NtpCounts counts_;
  std::unique_ptr<DatagramBatch> batch_;
  NodeReceiver* nodes_ = nullptr;  // set during serve()
};

}  // namespace kinalign
