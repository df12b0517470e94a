// SPDX-License-Identifier: Apache-2.0
// Several processes that train one model, joined by LibTorch's c10d with Gloo over TCP.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/learn/batch_share.h"

#include <cstdint>
#include <memory>
#include <string>

namespace kinalign {

/// This process among all of a training.
struct ProcessPlace {
  std::int64_t rank = 0, size = 1;
  std::string address;       // of the machine of the process 0
  std::uint16_t port = 0;    // that it waits for the others on
  std::string interface {};  // of the network between the processes, "eth1"; empty: found by itself
};

/// A batch has 32 examples; each process needs one.
inline constexpr std::int64_t most_processes = 32;

class Processes {
 public:
  /// Waits for all processes, five minutes at most. Alone where there is one. Fails where one does
  /// not come, where this program was built without Gloo, and for more than most_processes.
  static Result<Processes> join(const ProcessPlace& place);

  const BatchShare& share() const { return share_; }
  /// Fails unless all processes say the same `text`.
  Result<void> agree(const std::string& text);
  /// Waits for the others, so that nobody's last message is lost.
  void leave();

 private:
  struct Group;
  std::shared_ptr<Group> group_;  // also held by the share; none where alone
  BatchShare share_;
};

}  // namespace kinalign
