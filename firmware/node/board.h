// SPDX-License-Identifier: Apache-2.0
// The functions that a node needs of its board: all that differs from board to board.
#pragma once

#include "firmware/node/lights.h"

#include "kinalign/wire/node_sample.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace kinalign {

/// No function waits. The task that samples calls counter_us, read_imu, lock and unlock. The task
/// that sends calls all but read_imu. Both may be one task.
class Board {
 public:
  /// The counter in us since the start, read now. It never goes backwards: a board with a narrow
  /// counter counts its wraps.
  virtual std::uint64_t counter_us() = 0;
  /// Takes one reading, and fills in all but its age. False: the sensor did not answer.
  virtual bool read_imu(NodeSample& sample) = 0;
  /// Hands a datagram to the radio. False: it was not taken, and nothing of it will arrive.
  virtual bool send(std::span<const std::uint8_t> datagram) = 0;
  /// The next datagram that has arrived, cut to `room`. False: there is none.
  virtual bool receive(std::span<std::uint8_t> room, std::size_t& size) = 0;
  /// False where there is no battery, or none that can be measured.
  virtual bool read_battery(std::uint16_t& mv) = 0;
  /// Called when the lights have changed.
  virtual void show(const Lights& lights) = 0;
  /// Keep the other task from running between lock() and unlock(): for some microseconds, and never
  /// during a call of the board. They do nothing on a board with one task.
  virtual void lock() = 0;
  virtual void unlock() = 0;

 protected:
  ~Board() = default;  // a board lives as long as its node: it is never deleted through this class
};

/// Holds the board's lock while it exists.
class Locked {
 public:
  explicit Locked(Board& board) : board_(board) { board_.lock(); }
  ~Locked() { board_.unlock(); }
  Locked(const Locked&) = delete;
  Locked& operator=(const Locked&) = delete;

 private:
  Board& board_;
};

/// Shows the lights once at the start, and then each time they change.
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
