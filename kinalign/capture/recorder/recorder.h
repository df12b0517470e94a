// SPDX-License-Identifier: Apache-2.0
// What devices say, put into chunks: by channels, stamped, counted, a chunk closed four times a
// second. Before a take it keeps the last seconds (the pre-roll), which the take begins with. Has
// no thread, clock or file: time is an argument, and chunks go where start() says.
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

struct RecorderOptions {
  Duration chunk = std::chrono::milliseconds(250);  // what a kill costs at most, nearly
  std::size_t chunk_bytes = std::size_t{1} << 20;   // or earlier at that size
  Duration pre_roll = std::chrono::seconds(5);      // kept before a take
  /// At most. A take begins with all of them at once, and what comes next must have room beside
  /// them where chunks wait for the disk: less than DiskThread::most_waiting.
  std::size_t pre_roll_bytes = std::size_t{192} << 20;
  /// UTC less the host's axis, the same for the whole run: log times in a file are UTC.
  Duration utc_minus_host{};
};

class Recorder {
 public:
  using Take = std::function<void(McapChunkContent)>;

  explicit Recorder(const RecorderOptions& options) : options_(options) {}

  /// A channel to record on; its number. `schema`'s id is set here, absent: none. More than a file
  /// can number, 65,534, share one more, "/others".
  std::uint16_t add_channel(McapChannel channel, const McapSchema* schema = nullptr);

  /// `device`: on the device's own clock, ns; absent where it has none.
  void record(std::uint16_t channel, HostTime arrival, std::string_view data,
              std::optional<std::uint64_t> device_ns = std::nullopt);
  /// Closes a chunk that is due: some times a chunk's length.
  void tick(HostTime now);

  /// From now on chunks go to `take`, those of the pre-roll at once. The first one's number, of all
  /// that were ever begun.
  std::uint64_t start(HostTime now, Take take);
  /// The chunk that is open goes there, too; then none any more.
  void stop();
  bool started() const { return take_ != nullptr; }

  /// Whenever a chunk is closed: the next one's number, and that which a take would begin with.
  using Closed = std::function<void(std::uint64_t next, std::uint64_t first)>;
  void when_closed(Closed closed) { closed_ = std::move(closed); }

  /// Whatever is recorded, in takes and before. `schema`: nullptr where the channel has none.
  using Recorded = std::function<void(const McapSchema* schema, const McapChannel& channel,
                                      const McapMessage& message)>;
  void when_recorded(Recorded recorded) { recorded_ = std::move(recorded); }

  /// Recorded on a channel since it was added, in takes and before.
  std::uint64_t messages(std::uint16_t channel) const { return channels_[channel].messages; }
  std::uint64_t log_time(HostTime t) const;

 private:
  struct Channel {
    McapChannel channel;
    std::uint64_t messages = 0;
    bool in_chunk = false;  // its definition
  };
  std::uint16_t schema_id(const McapSchema& schema);
  void close();
  void forget_before(HostTime now);

  RecorderOptions options_;
  std::vector<McapSchema> schemas_;           // [i] has the id i + 1
  std::vector<Channel> channels_{Channel{}};  // [0]: none
  McapChunkContent chunk_;
  std::optional<HostTime> opened_;  // the chunk: the first arrival in it
  HostTime newest_{};               // arrival in it
  struct Kept {
    McapChunkContent chunk;
    HostTime end{};
    std::uint64_t number = 0;
  };
  std::uint64_t first_number() const;
  std::deque<Kept> pre_roll_;
  std::size_t pre_roll_bytes_ = 0;
  std::uint64_t number_ = 0;  // of the open chunk
  Closed closed_;
  Recorded recorded_;
  Take take_;
};

}  // namespace kinalign
