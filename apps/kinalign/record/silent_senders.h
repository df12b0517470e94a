// SPDX-License-Identifier: Apache-2.0
// Finds senders that fall silent or come back, each change once.
#pragma once

#include "apps/kinalign/text/record_text.h"

#include <set>
#include <string>
#include <vector>

namespace kinalign {

/// Invariant: silent_ holds the senders whose last reported change was silence.
class SilentSenders {
 public:
  struct Change {
    StreamStatus stream;
    bool silent = false;  // else the sender is back
  };
  /// The changes since the last call. A sender of one or two datagrams may be a stranger. Among
  /// senders of fewer than ten messages only the one that sent most of a stream is considered.
  std::vector<Change> changes(const LabStatus& status);

 private:
  std::set<std::string> silent_;  // senders reported as silent
};

}  // namespace kinalign
