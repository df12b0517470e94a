// SPDX-License-Identifier: Apache-2.0
// Writes text to a file descriptor. A slow reader either delays the program or makes text be
// dropped.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace kinalign {

/// Holds text until there are 64 KiB or flush() is called. After a write has failed for good, all
/// text is dropped without a message; fault() returns the reason.
class Outlet {
 public:
  explicit Outlet(int fd) : fd_(fd) {}
  Outlet(const Outlet&) = delete;
  Outlet& operator=(const Outlet&) = delete;
  ~Outlet();

  /// After this call a full pipe, a stopped terminal or a full disk no longer delays the program.
  /// Up to 1 MiB of text is held; further texts are dropped whole and counted.
  void never_wait();

  /// Adds the text to the held text, and writes if 64 KiB are held.
  void put(std::string_view text);
  /// Writes the held text. After never_wait(), text that the reader does not take within `patience`
  /// stays held.
  void flush(std::chrono::milliseconds patience = {});

  /// The number of texts dropped since the last call. Returns 0 while there is no room to report
  /// them.
  std::uint64_t take_dropped();
  bool holds() const { return !held_.empty(); }
  int fd() const { return fd_; }
  /// The errno of the last write if it failed; otherwise 0.
  int fault() const { return fault_; }
  /// True if a write has failed for good. Nothing more is written then.
  bool gave_up() const { return fault_ != 0 && !is_full(); }

 private:
  bool takes_more(std::chrono::milliseconds patience) const;
  bool is_full() const;
  int writes_to() const { return terminal_ >= 0 ? terminal_ : fd_; }

  int fd_;
  int terminal_ = -1;  // the same terminal opened a second time, with O_NONBLOCK
  bool waits_ = true;
  std::string held_;
  std::uint64_t dropped_ = 0;
  int fault_ = 0;
};

}  // namespace kinalign
