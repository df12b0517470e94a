// SPDX-License-Identifier: Apache-2.0
// Findings about the senders to a port. Each finding is reported once per host, because a faulty
// sender repeats its fault with every message.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <set>
#include <string>
#include <utility>

namespace kinalign {

/// The port is part of no key: a host that reconnects from another port is not reported again.
class FindingsOnce {
 public:
  // findings; the number of unknown senders' addresses has no limit
  static constexpr std::size_t most = 256;

  void add(const std::string& host, Finding finding) {
    if (reported_.size() >= most) return;
    const bool fresh = reported_.insert(host + finding.what.expected + finding.meaning).second;
    if (fresh) fresh_.push_back(std::move(finding));
  }
  /// Findings since the previous call.
  Findings take() { return std::exchange(fresh_, {}); }

 private:
  Findings fresh_;
  std::set<std::string> reported_;
};

}  // namespace kinalign
