// SPDX-License-Identifier: Apache-2.0
// Findings about those who send to a port, each told once of each host: who sends one thing that is
// amiss sends many.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <set>
#include <string>
#include <utility>

namespace kinalign {

class FindingsOnce {
 public:
  static constexpr std::size_t most = 256;  // strangers' addresses are without number

  void add(const std::string& host, Finding finding) {
    if (told_.size() >= most) return;
    const bool fresh = told_.insert(host + finding.what.expected + finding.meaning).second;
    if (fresh) fresh_.push_back(std::move(finding));
  }
  /// Those that came since this was asked last.
  Findings take() { return std::exchange(fresh_, {}); }

 private:
  Findings fresh_;
  std::set<std::string> told_;
};

}  // namespace kinalign
