// SPDX-License-Identifier: Apache-2.0
// Runs a network frame by frame. Convolutions keep earlier frames in ring buffers, lstm and gru
// keep their state.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/infer/network.h"

#include <cstddef>
#include <memory>
#include <span>

namespace kinalign {

/// Runs a network on frames as they arrive, for one sequence. Several objects of this class may
/// share a network, for example one object for each person.
class OnlineNetwork {
 public:
  /// Allocates all memory. The weights stay in `network`, which must outlive this object and may be
  /// moved. Fails if a layer needs later frames: a bidirectional layer, a centred convolution,
  /// max_pool, along_time. The error names the layer. Centred convolutions with one tap are
  /// accepted.
  static Result<OnlineNetwork> make(const Network& network);

  OnlineNetwork(OnlineNetwork&&) noexcept;
  OnlineNetwork& operator=(OnlineNetwork&&) noexcept;
  OnlineNetwork(const OnlineNetwork&) = delete;
  OnlineNetwork& operator=(const OnlineNetwork&) = delete;
  ~OnlineNetwork();

  /// Takes the next frame [inputs] and computes its result [outputs]. The result is valid until the
  /// next step and only as long as `frame` exists. The results equal those of Network::run over all
  /// frames since the start, bit by bit.
  std::span<const float> step(std::span<const float> frame);

  /// Forgets all earlier frames.
  void reset();

  /// Number of values in the state of all lstm and gru layers.
  std::size_t state_size() const;
  /// The state, layer by layer: an lstm's output and cell, a gru's output. Buffers of convolutions
  /// are not included.
  void get_state(std::span<float> state) const;  // [state_size]
  void set_state(std::span<const float> state);

 private:
  // State is defined in the .cpp, so this header needs no layers.
  struct State;
  explicit OnlineNetwork(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace kinalign
