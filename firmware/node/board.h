// SPDX-License-Identifier: Apache-2.0
// What a node asks of the board it runs on: all that is not the same on every board.
#pragma once

#include "firmware/node/lights.h"

#include "kinalign/wire/node_sample.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace kinalign {

/// Nothing here waits. counter_us, read_imu, lock and unlock are called by the task that samples,
/// all but read_imu by the one that sends; they may be one.
class Board {
 public:
  /// us since the start, read now; never backwards. Of a narrower counter the turns are counted.
  virtual std::uint64_t counter_us() = 0;
  /// One reading, all but its age. False: the sensor did not answer.
  virtual bool read_imu(NodeSample& sample) = 0;
  /// Hands a datagram to the radio. False: it was not taken, and nothing of it will arrive.
  virtual bool send(std::span<const std::uint8_t> datagram) = 0;
  /// The next datagram that has arrived, cut to `room`. False: there is none.
  virtual bool receive(std::span<std::uint8_t> room, std::size_t& size) = 0;
  /// False where there is no battery, or none that can be measured.
  virtual bool read_battery(std::uint16_t& mv) = 0;
  /// Called when they have changed.
  virtual void show(const Lights& lights) = 0;
  /// Between them the other task stands still: for some microseconds, never over a call of the
  /// board's. Nothing to do where there is one task.
  virtual void lock() = 0;
  virtual void unlock() = 0;

 protected:
  ~Board() = default;  // a board lives as long as its node: nobody deletes one
};

/// The board's lock, while this stands.
class Locked {
 public:
  explicit Locked(Board& board) : board_(board) { board_.lock(); }
  ~Locked() { board_.unlock(); }
  Locked(const Locked&) = delete;
  Locked& operator=(const Locked&) = delete;

 private:
  Board& board_;
};

/// Shows what has changed, and what there is at first.
class LightSwitch {
 public:
  void show(Board& board, const Lights& lights) {
    if (ever_ && lights == shown_) return;
    ever_ = true;
    shown_ = lights;
    board.show(lights);
  }

 private:
  Lights shown_;
  bool ever_ = false;
};

}  // namespace kinalign
