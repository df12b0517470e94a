// SPDX-License-Identifier: Apache-2.0
// Text on its way to a file descriptor: waiting for its reader, or never.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace kinalign {

class Outlet {
 public:
  explicit Outlet(int fd) : fd_(fd) {}
  Outlet(const Outlet&) = delete;
  Outlet& operator=(const Outlet&) = delete;
  ~Outlet();

  /// From here on a reader that doesn't read (a full pipe, a stopped terminal), or a full disk,
  /// holds up nothing: up to 1 MiB waits for it, what comes then is dropped, by whole texts, and
  /// counted.
  void never_wait();

  /// Holds it until there is enough to write.
  void put(std::string_view text);
  /// Writes what is held; what a reader that isn't waited for does not take within so long, stays.
  void flush(std::chrono::milliseconds patience = {});

  /// Texts dropped since this was asked; 0 as long as there is no room to tell it.
  std::uint64_t take_dropped();
  bool holds() const { return !held_.empty(); }
  int fd() const { return fd_; }
  /// errno of the write that failed last; 0: none, or another went well since.
  int fault() const { return fault_; }
  /// Nothing more is written.
  bool gave_up() const { return fault_ != 0 && !is_full(); }

 private:
  bool takes_more(std::chrono::milliseconds patience) const;
  bool is_full() const;
  int writes_to() const { return terminal_ >= 0 ? terminal_ : fd_; }

  int fd_;
  int terminal_ = -1;  // the same one opened anew, so that writing never blocks
  bool waits_ = true;
  std::string held_;
  std::uint64_t dropped_ = 0;
  int fault_ = 0;
};

}  // namespace kinalign
