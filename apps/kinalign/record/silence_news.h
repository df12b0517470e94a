// SPDX-License-Identifier: Apache-2.0
// Who falls silent while a lab is recorded, and who comes back: each told once.
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
  };
  /// Since this was asked last. Anybody's datagram or two on a device's port make no sender whose
  /// silence is told: of those who said little, that one alone who said most of the stream.
  std::vector<Change> changes(const LabStatus& status);

 private:
  std::set<std::string> known_;   // who once said more than a little
  std::set<std::string> silent_;  // who was told to be
};

}  // namespace kinalign
