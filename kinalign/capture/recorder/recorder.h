// SPDX-License-Identifier: Apache-2.0
// Collects the devices' messages in chunks, with channels, stamps and numbers. A chunk is closed
// four times a second. Before a take, the chunks of the last seconds are kept (the pre-roll); a
// take begins with them. The class has no thread, clock or file. The caller passes the time, and
// the function given to start() gets the chunks.
#pragma once

#include "kinalign/mcap/chunk.h"
#include "kinalign/wire/time.h"

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace kinalign {

/// The limits bound the memory of a recorder before a take.
struct RecorderOptions {
  // length of a chunk; a killed program loses little more than one chunk
  Duration chunk = std::chrono::milliseconds(250);
  std::size_t chunk_bytes = std::size_t{1} << 20;  // bytes; a chunk of this size is closed at once
  Duration pre_roll = std::chrono::seconds(5);     // time that is kept before a take
  /// Limit on the pre-roll, bytes. A take begins by queuing the whole pre-roll for the disk, and
  /// later chunks need space in the same queue. The limit must therefore be less than
  /// DiskThread::most_waiting.
  std::size_t pre_roll_bytes = std::size_t{192} << 20;
  /// UTC minus host time, constant for the whole run. Log times in a file are UTC.
  Duration utc_minus_host{};
};

/// Chunks are numbered over the whole run. A closed chunk goes to the take in progress. Without a
/// take, it goes into the pre-roll of the next take.
class Recorder {
 public:
  using Take = std::function<void(McapChunkContent)>;

  explicit Recorder(const RecorderOptions& options) : options_(options) {}

  /// Adds a channel and returns its number. This function sets the id of `schema`; nullptr: no
  /// schema. A file can number 65,534 channels; all further channels share the channel "/others".
  std::uint16_t add_channel(McapChannel channel, const McapSchema* schema = nullptr);

  /// Records one message. `device_ns`: stamp of the device's own clock, ns; absent if it has no
  /// clock.
  void record(std::uint16_t channel, HostTime arrival, std::string_view data,
              std::optional<std::uint64_t> device_ns = std::nullopt);
  /// Closes the chunk if it is old enough. Call several times per chunk length.
  void tick(HostTime now);

  /// Begins a take. The chunks of the pre-roll go to `take` at once, later chunks when they are
  /// closed. Returns the number of the take's first chunk, counted over the whole run.
  std::uint64_t start(HostTime now, Take take);
  /// Ends the take. The open chunk still goes to this take.
  void stop();
  bool started() const { return take_ != nullptr; }

  /// Called whenever a chunk is closed. The arguments are the number of the next chunk, and the
  /// number of the first chunk of a take that would begin now.
  using Closed = std::function<void(std::uint64_t next, std::uint64_t first)>;
  void when_closed(Closed closed) { closed_ = std::move(closed); }

  /// Called for every recorded message, also before takes. `schema` is nullptr if the channel has
  /// none.
  using Recorded = std::function<void(const McapSchema* schema, const McapChannel& channel,
                                      const McapMessage& message)>;
  void when_recorded(Recorded recorded) { recorded_ = std::move(recorded); }

 private:
  /// The channel with number i is channels_[i].
  struct Channel {
    McapChannel channel;
    std::uint64_t messages = 0;
    bool in_chunk = false;  // the open chunk contains the channel's definition
  };
  std::uint16_t schema_id(const McapSchema& schema);
  /// `close` ends the open chunk. `forget_before` removes old chunks from the pre-roll.
  void close();
  void forget_before(HostTime first);

  RecorderOptions options_;
  std::vector<McapSchema> schemas_;           // the schema [i] has the id i + 1
  std::vector<Channel> channels_{Channel{}};  // [0] is not used
  McapChunkContent chunk_;
  std::optional<HostTime> opened_;  // first arrival in the open chunk; absent: no chunk is open
  HostTime newest_{};               // newest arrival in the open chunk
  // A closed chunk of the pre-roll. `end`: its newest arrival.
  struct Kept {
    McapChunkContent chunk;
    HostTime end{};
    std::uint64_t number = 0;
  };
  std::uint64_t first_number() const;
  std::deque<Kept> pre_roll_;
  std::size_t pre_roll_bytes_ = 0;
  std::uint64_t number_ = 0;  // number of the open chunk
  Closed closed_;
  Recorded recorded_;
  Take take_;
};

}  // namespace kinalign
