// SPDX-License-Identifier: Apache-2.0
// A network that runs over whole sequences. OnlineNetwork (online.h) runs it frame by frame.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/infer/architecture.h"
#include "kinalign/infer/kernels.h"
#include "kinalign/infer/safetensors.h"

#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

struct PreparedNetwork;

/// Memory for values between layers. The caller keeps one workspace per thread and passes it to
/// every run. A run with no more frames than an earlier one allocates nothing.
class Workspace {
 public:
  /// The index of a free block with at least `values` values.
  std::size_t take(std::size_t values);
  void give_back(std::size_t block) { blocks_[block].taken = false; }
  float* values(std::size_t block) { return blocks_[block].values.data(); }
  void give_all_back();

  /// The number of frames before each max_pool whose unpool has not run yet. Filled by max_pool,
  /// emptied by unpool.
  std::vector<std::size_t> frames_before_pools;

 private:
  /// Blocks keep their memory when they are given back, so later runs need none.
  struct Block {
    std::vector<float> values;
    bool taken = false;
  };
  std::vector<Block> blocks_;
};

/// Weights that are ready to run. A run changes nothing in the network, so threads may share it,
/// each with its own workspace.
class Network {
 public:
  /// Fails if the architecture is not valid (shapes.h), or if a tensor `prefix` + name is missing,
  /// has another shape or contains a value that is not finite. Further tensors are ignored.
  static Result<Network> make(const Architecture& architecture,
                              const std::map<std::string, Tensor>& tensors,
                              const std::string& prefix = "",
                              const Kernels& kernels = best_kernels());

  Network(Network&&) noexcept;
  Network& operator=(Network&&) noexcept;
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;
  ~Network();

  const Architecture& architecture() const;
  std::size_t inputs() const;
  std::size_t outputs() const;

  /// Computes `out` [T,outputs] from `in` [T,inputs], T = `frames`, any number. Each max_pool
  /// without an unpool halves the frames of `out`, rounded up. Results do not depend on
  /// `workspace`.
  void run(std::span<const float> in, std::size_t frames, Workspace& workspace,
           std::vector<float>& out) const;

 private:
  // These two classes run the same prepared layers in other ways.
  friend class OnlineNetwork;
  friend class WindowNetwork;
  explicit Network(std::unique_ptr<const PreparedNetwork> prepared);

  std::unique_ptr<const PreparedNetwork> prepared_;
};

}  // namespace kinalign
