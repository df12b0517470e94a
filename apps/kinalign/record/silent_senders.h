// SPDX-License-Identifier: Apache-2.0
// Finds senders that fall silent or return. Each change is reported once.
#pragma once

#include "apps/kinalign/text/record_text.h"

#include <set>
#include <string>
#include <vector>

namespace kinalign {

/// Finds such changes. Invariant: silent_ has the senders that were reported as silent and have not
/// returned.
class SilentSenders {
 public:
  struct Change {
    StreamStatus stream;
    bool silent = false;  // false: the sender has returned
  };
  /// The changes since the last call. A sender with fewer than ten messages may not belong to the
  /// lab, so it is ignored if another sender of the same stream has sent more.
  std::vector<Change> changes(const LabStatus& status);

 private:
  std::set<std::string> silent_;  // the senders that were reported as silent
};

}  // namespace kinalign
