// SPDX-License-Identifier: Apache-2.0
// Sessions with given devices, frames of a suit, and a disk that makes them wait.
#pragma once

#include "tests/capture/recorded.h"

#include "kinalign/protocols/noitom/frame.h"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

namespace kinalign {

inline DeviceOptions device(const std::string& text) { return *parse_device(text); }

template <class Holds>
void serve_until(RecordingSession& session, const Holds& holds) {
  while (!holds())
    session.turn(std::chrono::milliseconds(10));  // CTest's own limit ends a test that hangs
}

/// A disk on which beginning a file waits for some seconds, or until the test releases it.
struct StandsStill : PosixFiles {
  std::atomic<bool> still{true};
  int open(const char* path, int flags, mode_t mode) override {
    for (int ms = 0; still && ms < 5000; ++ms)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return PosixFiles::open(path, flags, mode);
  }
};

inline std::vector<std::uint8_t> noitom_frame(std::uint32_t index) {
  NoitomFrame frame;
  frame.name = "Char00";
  frame.frame_index = index;
  frame.displacement = true;
  frame.values.assign(354, 1.0F);
  std::vector<std::uint8_t> bytes;
  append_noitom(frame, bytes);
  return bytes;
}

}  // namespace kinalign
