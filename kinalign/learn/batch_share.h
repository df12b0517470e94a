// SPDX-License-Identifier: Apache-2.0
// Data parallel training: each process computes a part of every batch. The parts' losses and
// gradients add up to those of the whole batch, so that the number of processes changes rounding
// alone. The processes are joined by whoever starts the training (apps/kinalign-learn/processes.h).
#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace kinalign {

/// Examples begin ... begin + count of a batch of `whole`.
struct BatchPart {
  std::int64_t begin = 0, count = 0, whole = 0;

  /// The part's share of a mean over the batch.
  torch::Tensor mean(const torch::Tensor& values) const {
    return values.mean() * (static_cast<double>(count) / static_cast<double>(whole));
  }
};

class BatchShare {
 public:
  /// Adds the tensors of all processes, in place and on the CPU. False: a process has ended; the
  /// values count for nothing then.
  using Sum = std::function<bool(torch::Tensor& values)>;

  /// One process, which computes the whole batch.
  BatchShare() = default;
  /// The process `rank` of `size`. All processes call sum() equally often, in the same order.
  BatchShare(std::int64_t rank, std::int64_t size, Sum sum)
      : rank_(rank), size_(size), sum_(std::move(sum)) {}

  bool is_alone() const { return size_ == 1; }
  /// Judges, keeps and writes for all.
  bool is_first() const { return rank_ == 0; }
  /// A process has ended before the others.
  bool is_broken() const { return broken_; }

  /// Processes beyond the examples of a batch have none.
  BatchPart part(std::int64_t batch) const {
    const std::int64_t begin = batch * rank_ / size_;
    return {begin, batch * (rank_ + 1) / size_ - begin, batch};
  }

  /// The sum over all processes, without gradient.
  torch::Tensor total(const torch::Tensor& part) const;
  /// The value of the first process.
  std::optional<double> of_first(const std::optional<double>& value) const;

 private:
  std::int64_t rank_ = 0, size_ = 1;
  Sum sum_;
  mutable bool broken_ = false;
};

}  // namespace kinalign
