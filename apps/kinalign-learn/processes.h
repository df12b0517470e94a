// SPDX-License-Identifier: Apache-2.0
// Several processes that train one model together, joined by LibTorch's c10d with Gloo over TCP.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/learn/batch_share.h"

#include <cstdint>
#include <memory>
#include <string>

namespace kinalign {

/// The place of this process among all processes of a training.
/// kinalign train finds it from --processes, or from the variables of srun and mpirun.
struct ProcessPlace {
  std::int64_t rank = 0, size = 1;
  std::string address;       // the address of process 0's machine
  std::uint16_t port = 0;    // on which process 0 waits for the others
  std::string interface {};  // network between the processes, "eth1"; empty: chosen by the program
};

/// A batch has 32 examples, and each process needs at least one.
inline constexpr std::int64_t most_processes = 32;

/// join() connects, agree() compares the jobs, share() divides the batches, leave() ends together.
/// A single process passes all of them without a network.
class Processes {
 public:
  /// Waits at most five minutes for all processes. A single process does not wait. Fails if a
  /// process does not come, if this program was built without Gloo, or with more than
  /// most_processes.
  static Result<Processes> join(const ProcessPlace& place);

  const BatchShare& share() const { return share_; }
  /// Fails unless all processes pass the same `text`.
  Result<void> agree(const std::string& text);
  /// Waits for the other processes, so that no last message is lost.
  void leave();

 private:
  struct Group;
  std::shared_ptr<Group> group_;  // also held by the share; nullptr for a single process
  BatchShare share_;
};

}  // namespace kinalign
