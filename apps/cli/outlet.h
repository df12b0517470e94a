// SPDX-License-Identifier: Apache-2.0
// Text on its way to a file descriptor; its reader is waited for, or never.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace kinalign {

/// Text is held until 64 KiB are together or flush() is called. After a fault that is final, text
/// is dropped in silence: fault() tells the caller.
class Outlet {
 public:
  explicit Outlet(int fd) : fd_(fd) {}
  Outlet(const Outlet&) = delete;
  Outlet& operator=(const Outlet&) = delete;
  ~Outlet();

  /// From here on a reader that does not read (a full pipe, a stopped terminal) or a full disk
  /// delays nothing. Up to 1 MiB of text waits for it; later texts are dropped whole and counted.
  void never_wait();

  /// Holds the text until there is enough to write.
  void put(std::string_view text);
  /// Writes the held text. If the reader is not waited for, the text that it does not take within
  /// `patience` stays held.
  void flush(std::chrono::milliseconds patience = {});

  /// The texts dropped since the last call; 0 while there is no room to report them.
  std::uint64_t take_dropped();
  bool holds() const { return !held_.empty(); }
  int fd() const { return fd_; }
  /// errno of the last write if it failed; 0 if it succeeded or there was none.
  int fault() const { return fault_; }
  /// True if a write failed for good: nothing more is written.
  bool gave_up() const { return fault_ != 0 && !is_full(); }

 private:
  bool takes_more(std::chrono::milliseconds patience) const;
  bool is_full() const;
  int writes_to() const { return terminal_ >= 0 ? terminal_ : fd_; }

  int fd_;
  int terminal_ = -1;  // the same terminal opened anew, so that writing never blocks
  bool waits_ = true;
  std::string held_;
  std::uint64_t dropped_ = 0;
  int fault_ = 0;
};

}  // namespace kinalign
