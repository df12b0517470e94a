// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/frames/accepted_frames.h"

#include "kinalign/wire/clockless.h"
#include "kinalign/wire/little_endian_reader.h"

#include <utility>

namespace kinalign {

namespace {

/// Decodes a node's frame or request. The result is empty if the message is neither, or is damaged.
std::optional<AcceptedFrame> frame_in(const RecordedMessage& message) {
  Envelope envelope;
  if (open_envelope(octets(message.payload), envelope) != NodeRefusal::none) return std::nullopt;
  // The recorder checked the datagram with the node's key. A recording does not contain the key, so
  // the check can't be repeated.
  envelope.mac_was_checked = true;
  AcceptedFrame out;
  out.number = envelope.origin.sequence;
  if (envelope.type == DatagramType::request) {
    ClocklessRequest request;
    if (decode(envelope, nullptr, request) != NodeRefusal::none) return std::nullopt;
    out.samples.front() = request.sample;
    out.sample_count = request.has_sample ? 1 : 0;
    return out;
  }
  NodeFrame frame;
  if (decode(envelope, nullptr, frame) != NodeRefusal::none) return std::nullopt;
  if (frame.n_tx_us > max_counter_us) return std::nullopt;
  out.n_tx = node_time(static_cast<std::int64_t>(frame.n_tx_us));
  out.samples = frame.samples;
  out.sample_count = frame.sample_count;
  return out;
}

}  // namespace

// Keeps the exchange until the next message, which must be the accepted datagram.
AnyExchange AcceptedFrames::take_exchange(const RecordedMessage& message) {
  if (auto recorded = to_exchange(message.payload)) {
    Exchange& e = recorded->exchange;
    e.boot = boot_in_epoch(e.boot, recorded->epoch);
    accepted_ = {e.boot, e.n_tx, 0, false, message.arrival};
    return e;
  }
  if (auto numbered = to_clockless(message.payload)) {
    ClocklessExchange& e = numbered->exchange;
    e.boot = boot_in_epoch(e.boot, numbered->epoch);
    accepted_ = {e.boot, std::nullopt, number_of(e), e.t6.has_value(), message.arrival};
    return e;
  }
  return {};
}

// The message must directly follow its exchange, with the same arrival and the same counter or
// number.
std::optional<AcceptedFrame> AcceptedFrames::take(const RecordedMessage& message) {
  // An exchange is used only once, whether its datagram follows or not.
  const auto accepted = std::exchange(accepted_, std::nullopt);
  const bool in_time = accepted && accepted->at == message.arrival;
  if (in_time && accepted->confirms) return std::nullopt;  // a confirm has no sample
  auto frame = frame_in(message);
  // The number in a datagram has 32 bits. The exchange contains the unwrapped number.
  const auto low = [](std::int64_t number) { return static_cast<std::uint32_t>(number); };
  const bool same = in_time && frame && accepted->n_tx == frame->n_tx &&
                    (accepted->n_tx || low(accepted->number) == low(frame->number));
  if (!same) {
    ++others;
    return std::nullopt;
  }
  frame->boot = accepted->boot;
  frame->number = accepted->number;
  return frame;
}

}  // namespace kinalign
