// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/recorder.h"

#include <algorithm>
#include <utility>

namespace kinalign {

// Numbers have 16 bits. The last number is shared by all further channels.
std::uint16_t Recorder::add_channel(McapChannel channel, const McapSchema* schema) {
  constexpr std::uint16_t last = 0xffff;
  if (channels_.size() > last) return last;
  if (channels_.size() == last) {
    channel = {0, 0, "/others", "", {}};
    schema = nullptr;
  }
  channel.id = static_cast<std::uint16_t>(channels_.size());
  channel.schema_id = 0;
  if (schema != nullptr) {
    channel.schema_id = schema_id(*schema);
  }
  channels_.push_back({std::move(channel)});
  return channels_.back().channel.id;
}

/// Channels with the same schema share its id.
std::uint16_t Recorder::schema_id(const McapSchema& schema) {
  const auto known = std::find_if(schemas_.begin(), schemas_.end(), [&](const McapSchema& other) {
    return other.name == schema.name && other.data == schema.data;
  });
  if (known != schemas_.end()) return known->id;
  schemas_.push_back(schema);
  return schemas_.back().id = static_cast<std::uint16_t>(schemas_.size());
}

// Each chunk must be readable alone, so it contains the definitions of its channels.
void Recorder::record(std::uint16_t number, HostTime arrival, std::string_view data,
                      std::optional<std::uint64_t> device_ns) {
  newest_ = opened_ ? std::max(newest_, arrival) : arrival;
  if (!opened_) opened_ = arrival;
  Channel& channel = channels_[number];
  const std::uint16_t schema_id = channel.channel.schema_id;
  const McapSchema* const schema = schema_id != 0 ? &schemas_[schema_id - 1U] : nullptr;
  if (!channel.in_chunk) {
    if (schema != nullptr) chunk_.add(*schema);
    chunk_.add(channel.channel);
    channel.in_chunk = true;
  }
  const auto log =
      static_cast<std::uint64_t>((arrival.time_since_epoch() + options_.utc_minus_host).count());
  // The sequence number counts all messages of a channel, also before takes. A gap between two
  // takes is therefore visible.
  const McapMessage message{number, static_cast<std::uint32_t>(channel.messages++), log,
                            device_ns.value_or(log), data};
  chunk_.add(message);
  if (recorded_) recorded_(schema, channel.channel, message);
  if (chunk_.size() >= options_.chunk_bytes) close();
}

// A chunk is closed after its time even if no message arrives, so that a killed program loses
// little.
void Recorder::tick(HostTime now) {
  if (opened_ && now - *opened_ >= options_.chunk) close();
  if (!started()) forget_before(now - options_.pre_roll);
}

// The chunk goes to the take in progress, or else to the pre-roll.
void Recorder::close() {
  if (!opened_) return;
  opened_.reset();
  McapChunkContent chunk = std::exchange(chunk_, {});
  for (Channel& channel : channels_) channel.in_chunk = false;
  const std::uint64_t number = number_++;
  if (started()) {
    take_(std::move(chunk));
  } else {
    pre_roll_bytes_ += chunk.size();
    pre_roll_.push_back({std::move(chunk), newest_, number});
  }
  if (closed_) closed_(number_, first_number());
}

// If the pre-roll is empty, a take that began now would begin with the open chunk.
std::uint64_t Recorder::first_number() const {
  return pre_roll_.empty() ? number_ : pre_roll_.front().number;
}

/// Discards whole chunks only. The kept chunks therefore cover up to one chunk more than the
/// pre-roll.
void Recorder::forget_before(HostTime first) {
  while (!pre_roll_.empty() &&
         (pre_roll_.front().end < first || pre_roll_bytes_ > options_.pre_roll_bytes)) {
    pre_roll_bytes_ -= pre_roll_.front().chunk.size();
    pre_roll_.pop_front();
  }
}

// The open chunk stays open and goes to the take as a whole.
std::uint64_t Recorder::start(HostTime now, Take take) {
  forget_before(now - options_.pre_roll);
  const std::uint64_t first = first_number();
  take_ = std::move(take);
  for (Kept& kept : std::exchange(pre_roll_, {})) take_(std::move(kept.chunk));
  pre_roll_bytes_ = 0;
  return first;
}

void Recorder::stop() {
  close();
  take_ = nullptr;
}

}  // namespace kinalign
