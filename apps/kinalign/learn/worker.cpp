// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/learn/worker.h"

#include "apps/cli/child_process.h"
#include "apps/kinalign/learn/shipped_models.h"

#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <optional>

namespace kinalign {

namespace {

/// The largest number of bytes without a line end. A line of kinalign-learn has some hundred bytes,
/// so a longer text does not come from it.
constexpr std::size_t longest_line = std::size_t{1} << 20U;

/// The path of kinalign-learn. After installation it is in the folder of this program, in a build
/// tree in a sibling folder. PATH is not searched.
Result<std::string> worker_program() {
  const std::filesystem::path own = program_folder();
  for (const auto& file : {own / "kinalign-learn", own / "../kinalign-learn/kinalign-learn"}) {
    if (::access(file.c_str(), X_OK) == 0) return file.lexically_normal().string();
  }
  return Failure(
      Error{"", 0, "the program kinalign-learn, which trains (built if libtorch-dev is installed)",
            "no kinalign-learn in the folder of kinalign"});
}

/// One process of kinalign-learn. Invariant: `out` is open as long as the child may run. wait_for()
/// closes it and sets `code`.
struct Child {
  pid_t id = 0;
  int out = -1;  // the reading end of the child's stdout; -1 after its end
  // `held`: output without a line end so far; `last`: the last JSON object that is no warning
  std::string held, last;
  int code = 0;            // exit code; 128 plus the number of the signal that ended the child
  bool was_ended = false;  // true: this program ended it
};

/// Starts kinalign-learn with a job file. Its stdout goes to a pipe. Its stderr is dropped, because
/// errors come as JSON on stdout.
Result<Child> start(const std::string& program, const std::string& job) {
  const auto ends = KA_TRY(child_pipe());
  const auto child = start_child(program, {"kinalign-learn", job}, ends[1], -1);
  // The parent closes its copy of the writing end. Otherwise the pipe would not end when the child
  // ends.
  ::close(ends[1]);
  if (!child) ::close(ends[0]);
  Child out;
  out.id = KA_TRY(child);
  out.out = ends[0];
  return out;
}

/// Closes the pipe and waits until the child has ended.
void wait_for(Child& child) {
  ::close(child.out);
  child.out = -1;
  child.code = wait_for_child(child.id);
}

/// Reads the output that is there and returns its complete lines. At the end of the output, waits
/// for the child.
std::vector<std::string> read_lines(Child& child) {
  std::array<char, 4096> buffer{};
  const ssize_t got = ::read(child.out, buffer.data(), buffer.size());
  if (got < 0 && errno == EINTR) return {};
  std::vector<std::string> out;
  // 0 means the end of the output. A line that is too long also ends the reading: the pipe is
  // closed, and the child fails when it writes to it.
  if (got <= 0 || child.held.size() > longest_line) {
    wait_for(child);
    return out;
  }
  child.held.append(buffer.data(), static_cast<std::size_t>(got));
  // One read may give several lines, or a part of a line, which is stored in `held`.
  for (std::size_t end = child.held.find('\n'); end != std::string::npos;
       end = child.held.find('\n')) {
    out.push_back(child.held.substr(0, end));
    child.held.erase(0, end + 1);
  }
  return out;
}

Error reported_error(const nlohmann::json& error) {
  return {error.value("file", ""), 0, error.value("expected", ""), error.value("found", "")};
}

/// All processes of one job. In every training step the processes wait for each other. If one
/// fails, the others would wait for ever, so they are ended.
class Workers {
 public:
  explicit Workers(const WorkerWatch& watch) : watch_(watch) {}
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  /// Kills all children that still run, so that none runs on after this program.
  ~Workers() {
    end_all(SIGKILL);
    for (Child& child : children_) {
      if (child.out >= 0) wait_for(child);
    }
  }

  Result<void> add(const std::string& program, const std::string& job) {
    children_.push_back(KA_TRY(start(program, job)));
    return {};
  }

  /// Runs until all children have ended. If a child has failed or the user has stopped the run, the
  /// others get SIGTERM after 3 s and SIGKILL after 6 s.
  void run() {
    std::optional<Clock::time_point> failed;
    while (poll_all()) {
      // `code` is 0 while a child runs, so only children that have ended count.
      const bool fails = std::any_of(children_.begin(), children_.end(),
                                     [](const Child& one) { return one.code != 0; });
      if (!fails && !stopped_) continue;
      if (!failed) failed = Clock::now();
      const auto since = Clock::now() - *failed;
      // A child that has lost another process usually ends within these 3 s and reports it. A
      // signal would prevent the report.
      if (since > grace) end_all(since > 2 * grace ? SIGKILL : SIGTERM);
    }
  }

  // A run that the user has stopped is tested first: it makes children fail, which is no fault of
  // theirs.
  Result<std::string> result() const {
    if (stopped_) return Failure(interruption());
    if (const Child* child = first_to_fail()) return Failure(error_of(*child));
    const std::string& last = children_.front().last;
    if (!last.empty()) return last;
    return Failure(Error{"", 0, "a result of kinalign-learn", "no result"});
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds grace{3};
  // The exit code of kinalign-learn if it has lost another process.
  static constexpr int lost_another = 4;

  /// Reads the output of all running children, for at most 200 ms. Returns false if all have ended.
  bool poll_all() {
    std::vector<pollfd> waits;
    std::vector<Child*> whose;
    // A child whose output has ended is finished, so it needs no poll().
    for (Child& child : children_) {
      if (child.out < 0) continue;
      waits.push_back({child.out, POLLIN, 0});
      whose.push_back(&child);
    }
    if (waits.empty()) return false;
    // After a timeout or a signal the caller checks the time and calls again.
    if (::poll(waits.data(), waits.size(), 200) <= 0) return true;
    for (std::size_t i = 0; i < waits.size(); ++i) {
      if (waits[i].revents == 0) continue;
      for (const std::string& line : read_lines(*whose[i])) take(*whose[i], line);
    }
    return true;
  }

  // Handles one line of JSON: a warning, a progress report, a row or the result. Only lines of the
  // first child are reported.
  void take(Child& child, const std::string& line) {
    // Libraries may print text on stdout that is no JSON. It is ignored.
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (!json.is_object()) return;
    const bool is_watched = &child == &children_.front();
    if (json.contains("warning")) {
      if (watch_.warn && is_watched) watch_.warn(json.value("warning", ""));
      return;
    }
    // The last object of a child is its result or its error.
    child.last = line;
    if (!is_watched) return;
    // A progress report has the member "done". All other objects are rows; the result counts as a
    // row, too.
    if (!json.contains("done")) {
      if (watch_.row && !json.contains("error")) watch_.row(line);
      return;
    }
    // After the user has stopped the run, late reports must not show the progress line again.
    if (stopped_) return;
    stopped_ = !go_on(watch_.progress, json.value("what", ""), json.value("done", std::uint64_t{0}),
                      json.value("total", std::uint64_t{0}));
    if (stopped_) end_all(SIGTERM);
  }

  void end_all(int signal) {
    // A child whose output has ended is finished, and its id may belong to another process now.
    for (Child& child : children_) {
      if (child.out < 0) continue;
      ::kill(child.id, signal);
      child.was_ended = true;
    }
  }

  /// The child that caused the failure. A child that this program ended, or that lost another
  /// process, is chosen only if there is no other.
  const Child* first_to_fail() const {
    const Child* out = nullptr;
    for (const Child& child : children_) {
      if (child.code == 0) continue;
      // Signals of this program and the loss of another process are consequences. The cause is a
      // child that failed by itself.
      const bool by_itself = !child.was_ended && child.code != lost_another;
      if (out == nullptr || (by_itself && out->code == lost_another) ||
          (by_itself && out->was_ended)) {
        out = &child;
      }
    }
    return out;
  }

  // The error that the child has reported, else its exit code or signal.
  Error error_of(const Child& child) const {
    const auto json = nlohmann::json::parse(child.last, nullptr, false);
    // A reported error names a file and what was expected, so it says more than an exit code.
    if (json.is_object() && json.contains("error")) return reported_error(json.at("error"));
    std::string who = "kinalign-learn";
    if (children_.size() > 1) {
      who = "process " + std::to_string(&child - children_.data()) + " (of 0 to " +
            std::to_string(children_.size() - 1) + ") of kinalign-learn";
    }
    return {"", 0, who + " to end with exit code 0",
            child.code > 128 ? "signal " + std::to_string(child.code - 128)
                             : "exit code " + std::to_string(child.code)};
  }

  const WorkerWatch& watch_;
  std::vector<Child> children_;
  bool stopped_ = false;
};

}  // namespace

Result<std::string> run_workers(const std::vector<std::string>& job_files,
                                const WorkerWatch& watch) {
  const std::string program = KA_TRY(worker_program());
  // If a child can't be started, the destructor kills those that were started before.
  Workers workers(watch);
  for (const std::string& file : job_files) KA_TRY(workers.add(program, file));
  workers.run();
  return workers.result();
}

Result<std::uint16_t> free_port() {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  // For port 0 the system chooses a free port. It is free for the worker when the socket is closed.
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t length = sizeof address;
  const bool found =
      socket >= 0 &&
      ::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &length) == 0;
  // errno is read before close() may change it.
  const std::string fault = std::strerror(errno);
  if (socket >= 0) ::close(socket);
  if (found) return ntohs(address.sin_port);
  return Failure(Error{"", 0, "a free port of this machine", fault});
}

Result<std::string> run_worker(const std::string& job_file, const WorkerWatch& watch) {
  return run_workers({job_file}, watch);
}

}  // namespace kinalign
