// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/dataset/own_process.h"

#include "apps/cli/child_process.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <utility>

namespace kinalign {

namespace {

// Linux makes this link to the running program's file. It works even if the program was found
// through PATH or its file was moved.
constexpr const char* own_program = "/proc/self/exe";
constexpr std::size_t longest_complaint = 4096;

/// Reads a pipe until its other end is closed. Returns only the beginning of the text.
std::string drained(int pipe) {
  std::string out;
  std::array<char, 1024> buffer{};
  for (;;) {
    const ssize_t got = ::read(pipe, buffer.data(), buffer.size());
    // A signal may interrupt read(). Only the end of the text or a fault ends the loop.
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return out;
    // The rest is read and dropped, because a child whose pipe is full would wait for ever.
    if (out.size() < longest_complaint) out.append(buffer.data(), static_cast<std::size_t>(got));
  }
}

}  // namespace

Result<Ended> run_own_process(const std::vector<std::string>& words) {
  std::vector<std::string> all{"kinalign"};
  all.insert(all.end(), words.begin(), words.end());
  const auto ends = KA_TRY(child_pipe());
  const auto child = start_child(own_program, std::move(all), -1, ends[1]);
  // The parent must close its copy of the writing end: as long as it is open, the pipe has no end.
  ::close(ends[1]);
  Ended out;
  if (child) {
    // The pipe is read before waiting. In the other order the child could wait for room in the
    // pipe, and this process for the child.
    out.complaint = drained(ends[0]);
    out.code = wait_for_child(*child);
  }
  ::close(ends[0]);
  KA_TRY(child);
  return out;
}

}  // namespace kinalign
