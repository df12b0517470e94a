// SPDX-License-Identifier: Apache-2.0
// Findings about the senders to a port. A faulty sender repeats its fault with every message, so
// each finding is reported once per host.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <set>
#include <string>
#include <utility>

namespace kinalign {

/// The key does not contain the port, so a host that reconnects from another port is not reported
/// again.
class FindingsOnce {
 public:
  // findings; without a limit, each new sender address would use memory
  static constexpr std::size_t most = 256;

  void add(const std::string& host, Finding finding) {
    if (reported_.size() >= most) return;
    const bool fresh = reported_.insert(host + finding.what.expected + finding.meaning).second;
    if (fresh) fresh_.push_back(std::move(finding));
  }
  /// Findings since the previous call of this function.
  Findings take() { return std::exchange(fresh_, {}); }

 private:
  Findings fresh_;
  std::set<std::string> reported_;
};

}  // namespace kinalign
