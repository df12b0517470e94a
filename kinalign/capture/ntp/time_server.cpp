// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/ntp/time_server.h"

#include "kinalign/capture/net/host_clock.h"

#include <poll.h>

#include <array>

namespace kinalign {

namespace {

constexpr Duration tick = std::chrono::milliseconds(250);
constexpr int batches_in_turn = 16;  // batches of one socket before other sockets have their turn

Time now_utc() { return SystemClocks{}.utc(); }
HostTime now_host() { return SystemClocks{}.raw(); }

// If the kernel gave no stamp, the time of reading is used as the arrival.
NtpAsked asked_of(const Datagram& datagram, std::uint16_t port, Time now) {
  return {.bytes = datagram.bytes,
          .cut = datagram.cut,
          .from = datagram.from,
          .from_port = datagram.from_port,
          .to = datagram.to,
          .to_port = port,
          .unicast = datagram.unicast,
          .received = datagram.received.value_or(now)};
}

}  // namespace

Result<TimeServer> TimeServer::open(const TimeServerOptions& options) {
  return TimeServer(options, KA_TRY(open_udp_sockets(options.addresses, options.port)));
}

TimeServer::TimeServer(const TimeServerOptions& options, std::vector<UdpSocket> sockets)
    : policy_{options.local_stratum, measured_precision()},
      chrony_(options.chrony_port),
      sockets_(std::move(sockets)),
      responder_(options.key, options.exempt),
      batch_(std::make_unique<DatagramBatch>()) {
  // The first answers should already contain chronyd's distance, so the server waits up to 100 ms
  // for its report.
  if (is_synchronised(read_kernel_clock())) {
    chrony_.latest(now_host());
    chrony_.wait();
  }
  look_at_clock();
}

void TimeServer::look_at_clock() {
  const auto kernel = read_kernel_clock();
  // chronyd states a distance only for a synchronised clock.
  const auto chrony = is_synchronised(kernel) ? chrony_.latest(now_host()) : std::nullopt;
  responder_.set_state(server_state(kernel, chrony, policy_, now_utc()));
}

// The state of the clock is read once per tick, because requests may arrive more often.
void TimeServer::serve(const std::function<bool()>& go_on, NodeReceiver* nodes) {
  nodes_ = nodes;
  while (go_on()) {
    look_at_clock();
    if (nodes_ != nullptr) nodes_->tick();
    serve_until(now_host() + tick);
  }
  nodes_ = nullptr;
}

// Every readable socket is read before the next poll. The nodes' port is read first.
void TimeServer::serve_until(HostTime end) {
  std::vector<pollfd> waiting;
  if (nodes_ != nullptr) {
    waiting.push_back({nodes_->fd(), POLLIN, 0});
  }
  const std::size_t own = waiting.size();  // index of the first NTP socket
  for (const UdpSocket& socket : sockets_) waiting.push_back({socket.fd(), POLLIN, 0});
  for (Duration left = tick; left > Duration{0}; left = std::min(end - now_host(), tick)) {
    const auto whole_ms = std::chrono::ceil<std::chrono::milliseconds>(left).count();
    const int ready = ::poll(waiting.data(), waiting.size(), static_cast<int>(whole_ms));
    if (ready <= 0) return;  // the time is over, or a signal arrived
    if (nodes_ != nullptr) nodes_->drain();
    for (std::size_t i = 0; i < sockets_.size(); ++i) {
      if (waiting[own + i].revents != 0) drain(sockets_[i]);
    }
  }
}

void TimeServer::drain(const UdpSocket& socket) {
  for (int i = 0; i < batches_in_turn; ++i) {
    const std::size_t datagrams = batch_->receive(socket.fd());
    if (datagrams == 0) return;
    answer(socket, datagrams);
    if (nodes_ != nullptr) nodes_->drain();  // a flood on this port must not delay the nodes' port
  }
}

// An outcome is counted after sending, since the system may not accept the answer.
void TimeServer::answer(const UdpSocket& socket, std::size_t datagrams) {
  // One clock reading suffices for the rate limit of the whole batch.
  const HostTime host_now = now_host();
  std::array<NtpOutcome, DatagramBatch::most> outcomes{};
  for (std::size_t i = 0; i < datagrams; ++i) {
    const Datagram datagram = batch_->at(i);
    const Time now = now_utc();
    outcomes[i] = responder_.respond(asked_of(datagram, socket.port(), now), now, host_now,
                                     batch_->answer_to(i).first<ntp_packet_size>());
    const bool sends = outcomes[i] == NtpOutcome::answered || outcomes[i] == NtpOutcome::kissed;
    if (sends) batch_->queue(i, datagram, ntp_packet_size);
  }
  for (const std::size_t i : batch_->send(socket.fd())) outcomes[i] = NtpOutcome::unsent;
  for (std::size_t i = 0; i < datagrams; ++i) ++counts_[outcomes[i]];
}

}  // namespace kinalign
