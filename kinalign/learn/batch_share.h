// SPDX-License-Identifier: Apache-2.0
// Data-parallel training: each process computes a part of every batch. Losses and gradients of the
// parts add up to those of the whole batch, so the number of processes changes only rounding. The
// program that starts the training connects the processes (apps/kinalign-learn/processes.h).
#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace kinalign {

/// Examples begin ... begin + count - 1 of a batch of `whole` examples.
struct BatchPart {
  std::int64_t begin = 0, count = 0, whole = 0;

  /// The part's contribution to the mean over the whole batch.
  torch::Tensor mean(const torch::Tensor& values) const {
    return values.mean() * (static_cast<double>(count) / static_cast<double>(whole));
  }
};

/// The connection of a process to the others. If one sum fails, `broken_` stays true and no further
/// sum is tried, because the processes are then at different steps.
class BatchShare {
 public:
  /// Adds the tensors of all processes, in place and on the CPU. Returns false if a process has
  /// ended; the values are then invalid.
  using Sum = std::function<bool(torch::Tensor& values)>;

  /// A single process, which computes the whole batch.
  BatchShare() = default;
  /// The process `rank` of `size`. All processes must call `sum` equally often and in the same
  /// order.
  BatchShare(std::int64_t rank, std::int64_t size, Sum sum)
      : rank_(rank), size_(size), sum_(std::move(sum)) {}

  bool is_alone() const { return size_ == 1; }
  /// True for the process that measures the validation error, stores checkpoints and writes files.
  bool is_first() const { return rank_ == 0; }
  /// True if another process has ended too early.
  bool is_broken() const { return broken_; }

  /// This process's part of a batch. If there are more processes than examples, some parts are
  /// empty.
  BatchPart part(std::int64_t batch) const {
    // The numbers are rounded in the same way for all ranks, so the parts cover the batch without
    // gap or overlap.
    const std::int64_t begin = batch * rank_ / size_;
    return {begin, batch * (rank_ + 1) / size_ - begin, batch};
  }

  /// The sum over all processes, without gradient.
  torch::Tensor total(const torch::Tensor& part) const;
  /// The value of the first process, which is sent to all processes.
  std::optional<double> of_first(const std::optional<double>& value) const;

 private:
  std::int64_t rank_ = 0, size_ = 1;
  Sum sum_;
  mutable bool broken_ = false;
};

}  // namespace kinalign
