// SPDX-License-Identifier: Apache-2.0
// Runs a network over a moving window of the newest frames. Each run computes only the values that
// depend on new or changed frames, and only as far as results are requested. For each new frame, a
// convolution with five taps thus costs a few frames instead of the whole window. Networks with
// layers that use many frames (lstm, gru, max_pool, unpool, along_time) run over the whole window
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
  /// The weights stay in `network`, which must outlive this object and must not be moved.
  explicit WindowNetwork(const Network& network);
  WindowNetwork(WindowNetwork&&) noexcept;
  WindowNetwork& operator=(WindowNetwork&&) noexcept;
  WindowNetwork(const WindowNetwork&) = delete;
  WindowNetwork& operator=(const WindowNetwork&) = delete;
  ~WindowNetwork();

  /// The first `count` frames have left the window.
  void forget(std::size_t count);

  /// Computes the results [end, outputs] of the first `end` frames of the window (`end` >= 1). `in`
  /// [frames, inputs] is the whole window. The frames before `changed` must be the same as in the
  /// previous run. Frames that were not in the previous run always count as changed.
  /// Suppose that before each new frame the window contains look_back() frames (shapes.h), or all
  /// frames since the start. The results then equal those of Network::run over all frames since the
  /// start, bit by bit. Otherwise they equal those of Network::run over the window.
  /// A centred convolution also reads later frames. At the end of the window these are missing, and
  /// zeros are used instead. The last results therefore change when more frames arrive. The
  /// returned span is valid until the next call.
  std::span<const float> run(std::span<const float> in, std::size_t frames, std::size_t changed,
                             std::size_t end);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace kinalign
