// SPDX-License-Identifier: Apache-2.0
// A network over a window of the newest frames that moves on. Each run computes only what depends
// on frames that are new or have changed, and only as far as results are wanted: frame by frame a
// convolution of five taps costs a few frames instead of the whole window. Networks of which a
// result depends on all frames (lstm, gru, max_pool, along_time) run over the whole window anew.
#pragma once

#include "kinalign/infer/network.h"

#include <cstddef>
#include <memory>
#include <span>

namespace kinalign {

class WindowNetwork {
 public:
  /// The weights stay in `network`, which must live longer and must not be moved.
  explicit WindowNetwork(const Network& network);
  WindowNetwork(WindowNetwork&&) noexcept;
  WindowNetwork& operator=(WindowNetwork&&) noexcept;
  ~WindowNetwork();

  /// The first `count` frames of the window are gone.
  void forget(std::size_t count);

  /// The results [end, outputs] of the window's frames before `end`, which is 1 or more. `in`
  /// [frames, inputs] is the window. Its rows from `changed` on differ from those of the run before
  /// or are new. Where look_back() (shapes.h) is bounded and the window reaches as far back, the
  /// results are those of Network::run over all frames since the start, bit by bit; else those of
  /// Network::run over the window. Valid until the next call.
  std::span<const float> run(std::span<const float> in, std::size_t frames, std::size_t changed,
                             std::size_t end);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace kinalign
