// SPDX-License-Identifier: Apache-2.0
// Lets several processes train one model together, with LibTorch's c10d and Gloo over TCP.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/learn/batch_share.h"

#include <cstdint>
#include <memory>
#include <string>

namespace kinalign {

/// The place of this process among all processes of a training. `kinalign train` takes it from
/// --processes or from the environment variables of srun and mpirun.
struct ProcessPlace {
  std::int64_t rank = 0, size = 1;
  std::string address;       // the address of the machine that runs process 0
  std::uint16_t port = 0;    // the port on which process 0 waits for the others
  std::string interface {};  // the network to use, such as "eth1"; empty: chosen here
};

/// A batch has 32 examples, and each process needs at least one of them.
inline constexpr std::int64_t most_processes = 32;

/// The processes of one training. join() connects them, agree() compares their jobs, share()
/// divides each batch among them, leave() ends them together. A single process uses no network.
class Processes {
 public:
  /// Waits up to five minutes for all processes; a single process does not wait. Fails if a process
  /// does not come, if there are more than most_processes, or if this program was built without
  /// Gloo.
  static Result<Processes> join(const ProcessPlace& place);

  const BatchShare& share() const { return share_; }
  /// Fails unless all processes call agree() with the same `text`.
  Result<void> agree(const std::string& text);
  /// Waits until the other processes, too, have finished, so that no message between them is lost.
  void leave();

 private:
  struct Group;
  std::shared_ptr<Group> group_;  // share_ has a copy; nullptr for a single process
  BatchShare share_;
};

}  // namespace kinalign
