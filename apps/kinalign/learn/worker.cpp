// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/learn/worker.h"

#include "apps/kinalign/learn/shipped_models.h"

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

namespace kinalign {

namespace {

constexpr std::size_t longest_line = std::size_t{1} << 20U;

Result<std::string> worker_program() {
  const std::filesystem::path own = program_folder();
  for (const auto& file : {own / "kinalign-learn", own / "../kinalign-learn/kinalign-learn"}) {
    if (::access(file.c_str(), X_OK) == 0) return file.lexically_normal().string();
  }
  return Failure(Error{"", 0,
                       "the program kinalign-learn, which trains (built where libtorch-dev is "
                       "installed)",
                       "none beside kinalign"});
}

struct Child {
  pid_t id = 0;
  int out = -1;
};

Result<Child> start(const std::string& program, const std::string& job) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    return Failure(Error{"", 0, "a pipe to a child process", std::strerror(errno)});
  }
  std::string name = "kinalign-learn", word = job;
  const std::array<char*, 3> words{name.data(), word.data(), nullptr};
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
  ::posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
  Child out{0, ends[0]};
  const int fault =
      ::posix_spawn(&out.id, program.c_str(), &actions, nullptr, words.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  if (fault == 0) return out;
  ::close(ends[0]);
  return Failure(Error{program, 0, "a program that can be started", std::strerror(fault)});
}

/// Lines of the child's output until its end.
class Lines {
 public:
  explicit Lines(int pipe) : pipe_(pipe) {}
  bool next(std::string& line) {
    for (;;) {
      if (const std::size_t end = held_.find('\n'); end != std::string::npos) {
        line = held_.substr(0, end);
        held_.erase(0, end + 1);
        return true;
      }
      std::array<char, 4096> buffer{};
      const ssize_t got = ::read(pipe_, buffer.data(), buffer.size());
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0 || held_.size() > longest_line) return false;
      held_.append(buffer.data(), static_cast<std::size_t>(got));
    }
  }

 private:
  int pipe_;
  std::string held_;
};

int wait_for(const Child& child) {
  ::close(child.out);
  int status = 0;
  while (::waitpid(child.id, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

Error told_error(const nlohmann::json& error) {
  return {error.value("file", ""), 0, error.value("expected", ""), error.value("found", "")};
}

}  // namespace

Result<std::string> run_worker(const std::string& job_file, const WorkerWatch& watch) {
  const Child child = KA_TRY(start(KA_TRY(worker_program()), job_file));
  Lines lines(child.out);
  std::string line, last;
  bool stopped = false;
  while (lines.next(line)) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (!json.is_object()) continue;
    if (json.contains("warning")) {
      if (watch.warn) watch.warn(json.value("warning", ""));
      continue;
    }
    last = line;
    if (!json.contains("done") || stopped) continue;
    if (go_on(watch.progress, json.value("what", ""), json.value("done", std::uint64_t{0}),
              json.value("total", std::uint64_t{0}))) {
      continue;
    }
    stopped = true;
    ::kill(child.id, SIGTERM);
  }
  const int code = wait_for(child);
  if (stopped) return Failure(interruption());
  const auto json = nlohmann::json::parse(last, nullptr, false);
  if (json.is_object() && json.contains("error")) return Failure(told_error(json.at("error")));
  if (code == 0 && json.is_object()) return last;
  return Failure(Error{"", 0, "kinalign-learn to end well", "exit code " + std::to_string(code)});
}

}  // namespace kinalign
