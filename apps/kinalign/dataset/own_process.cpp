// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/dataset/own_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace kinalign {

namespace {

// The link leads to the running program's file, also if the program was started through PATH or the
// file was moved.
constexpr const char* own_program = "/proc/self/exe";
constexpr std::size_t longest_complaint = 4096;

/// Reads until the other end closes; keeps only the beginning.
std::string drained(int pipe) {
  std::string out;
  std::array<char, 1024> buffer{};
  for (;;) {
    const ssize_t got = ::read(pipe, buffer.data(), buffer.size());
    // A signal may interrupt the call. Only an end of the pipe or a fault ends the loop.
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return out;
    // The rest is read and dropped: a child whose pipe is full would wait for ever.
    if (out.size() < longest_complaint) out.append(buffer.data(), static_cast<std::size_t>(got));
  }
}

/// Waits for the child. A signal's number becomes 128 + N, as in a shell.
int code_of(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return -1;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

Result<Ended> run_own_process(const std::vector<std::string>& words) {
  // O_CLOEXEC keeps both ends out of the child. dup2 makes a copy on descriptor 2 that stays open
  // there.
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    return Failure(Error{"", 0, "a pipe to a child process", std::strerror(errno)});
  }
  std::vector<std::string> all{"kinalign"};
  all.insert(all.end(), words.begin(), words.end());
  // posix_spawn takes char*. The strings of `all` must not move any more once their addresses are
  // taken.
  std::vector<char*> arguments;
  arguments.reserve(all.size() + 1);
  for (std::string& word : all) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], 2);
  pid_t child = 0;
  const int fault =
      ::posix_spawn(&child, own_program, &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  // The parent must close its copy of the writing end. Otherwise drained() would never see the end.
  ::close(ends[1]);
  Ended out;
  if (fault == 0) {
    // The pipe is read to its end before waiting: in the other order a talkative child and this
    // process could wait for each other.
    out.complaint = drained(ends[0]);
    out.code = code_of(child);
  }
  ::close(ends[0]);
  if (fault == 0) return out;
  return Failure(Error{own_program, 0, "a program that can be started", std::strerror(fault)});
}

}  // namespace kinalign
