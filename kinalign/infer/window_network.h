// SPDX-License-Identifier: Apache-2.0
// Runs a network over a moving window of the newest frames. Each run computes only values that
// depend on new or changed frames, and only as far as results are requested. Frame by frame, a
// convolution with five taps thus costs a few frames instead of the whole window. Networks whose
// results depend on all frames (lstm, gru, max_pool, unpool, along_time) run over the whole window
// each time.
#pragma once

#include "kinalign/infer/network.h"

#include <cstddef>
#include <memory>
#include <span>

namespace kinalign {

/// Use: `forget` the frames that left the window, then `run` on the window that remains, with the
/// new frames after it.
class WindowNetwork {
 public:
  /// The weights stay in `network`, which must live longer and must not be moved.
  explicit WindowNetwork(const Network& network);
  WindowNetwork(WindowNetwork&&) noexcept;
  WindowNetwork& operator=(WindowNetwork&&) noexcept;
  WindowNetwork(const WindowNetwork&) = delete;
  WindowNetwork& operator=(const WindowNetwork&) = delete;
  ~WindowNetwork();

  /// The first `count` frames have left the window.
  void forget(std::size_t count);

  /// Computes the results [end, outputs] of the window's frames before `end`, which must be at
  /// least 1. `in` [frames, inputs] is the window. Rows from `changed` on differ from the previous
  /// run; rows that it did not have are new anyway. If look_back() (shapes.h) is bounded and the
  /// window reaches as far back, the results equal those of Network::run over all frames since the
  /// start, bit by bit. Otherwise they equal those of Network::run over the window. The span is
  /// valid until the next call.
  /// Frames near the end of the window lack the later ones that a centred convolution reads; zeros
  /// stand for these. Their results change when more frames arrive.
  std::span<const float> run(std::span<const float> in, std::size_t frames, std::size_t changed,
                             std::size_t end);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace kinalign
