// SPDX-License-Identifier: Apache-2.0
// Reports senders that fall silent or come back, each change once.
#pragma once

#include "apps/kinalign/text/record_text.h"

#include <set>
#include <string>
#include <vector>

namespace kinalign {

class SilenceNews {
 public:
  struct Change {
    StreamStatus stream;
    bool silent = false;  // else it is back
  };                      // false: it is back
  /// The changes since the last call. A stray datagram or two on a device's port make no sender
  /// whose silence matters: among senders with few messages only the one with the most counts.
  std::vector<Change> changes(const LabStatus& status);

 private:
  std::set<std::string> known_;   // senders that once had more than a few messages
  std::set<std::string> silent_;  // senders reported as silent
};

}  // namespace kinalign
