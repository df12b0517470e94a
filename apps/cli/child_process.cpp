// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace kinalign {

Result<std::array<int, 2>> child_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) == 0) return ends;
  return Failure(Error{"", 0, "a pipe to a child process", std::strerror(errno)});
}

Result<pid_t> start_child(const std::string& program, std::vector<std::string> words, int out,
                          int err) {
  // posix_spawn takes pointers to the characters of `words`. `words` must not change after the
  // pointers are taken.
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  for (const auto& [from, to] : {std::pair(out, 1), std::pair(err, 2)}) {
    if (from < 0) {
      ::posix_spawn_file_actions_addopen(&actions, to, "/dev/null", O_WRONLY, 0);
    } else {
      ::posix_spawn_file_actions_adddup2(&actions, from, to);
    }
  }
  pid_t child = 0;
  const int fault =
      ::posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (fault == 0) return child;
  return Failure(Error{program, 0, "a program that can be started", std::strerror(fault)});
}

int wait_for_child(pid_t child) {
  int status = 0;
  // A signal to this process may interrupt waitpid(). The child still runs then, so waiting goes
  // on.
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return -1;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace kinalign
