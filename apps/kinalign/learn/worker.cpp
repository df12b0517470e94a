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

/// Output without a line's end is limited to this number of bytes.
/// A line of the worker is a JSON object of some hundred bytes. A longer text is no output of
/// kinalign-learn.
constexpr std::size_t longest_line = std::size_t{1} << 20U;

/// The path of kinalign-learn: in the program's folder when installed, in a sibling folder in the
/// build tree.
/// The search goes by folders and never by PATH.
Result<std::string> worker_program() {
  const std::filesystem::path own = program_folder();
  for (const auto& file : {own / "kinalign-learn", own / "../kinalign-learn/kinalign-learn"}) {
    if (::access(file.c_str(), X_OK) == 0) return file.lexically_normal().string();
  }
  return Failure(
      Error{"", 0, "the program kinalign-learn, which trains (built if libtorch-dev is installed)",
            "no kinalign-learn in the folder of kinalign"});
}

/// One process of kinalign-learn.
/// Invariant: `out` is open as long as the child may run. wait_for() closes it and sets `code`.
struct Child {
  pid_t id = 0;
  int out = -1;            // its stdout; -1 after its end
  std::string held, last;  // output without a line's end yet; the last JSON object that is no
                           // warning
  int code = 0;            // exit code; 128 plus the signal's number if a signal ended it
  bool was_ended = false;  // by this program
};

/// Starts kinalign-learn with a job file. Its stdout is a pipe; its stderr is dropped, since errors
/// come as JSON on stdout.
Result<Child> start(const std::string& program, const std::string& job) {
  const auto ends = KA_TRY(child_pipe());
  const auto child = start_child(program, {"kinalign-learn", job}, ends[1], -1);
  // The parent's copy of the writing end must be closed, so that the end of the output is the end
  // of the child.
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

/// Reads the available output and returns its whole lines. At the end of the output it waits for
/// the child.
std::vector<std::string> read_lines(Child& child) {
  std::array<char, 4096> buffer{};
  const ssize_t got = ::read(child.out, buffer.data(), buffer.size());
  if (got < 0 && errno == EINTR) return {};
  std::vector<std::string> out;
  // 0 is the end of the output. A line that is too long ends the reading as well; the child then
  // fails on its closed pipe.
  if (got <= 0 || child.held.size() > longest_line) {
    wait_for(child);
    return out;
  }
  child.held.append(buffer.data(), static_cast<std::size_t>(got));
  // One read may have several lines, or a part of one. The rest waits in `held`.
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

/// All processes of one job.
/// All processes of a training wait for each other in every step. If one fails, the others would
/// wait for ever, so they are ended.
class Workers {
 public:
  explicit Workers(const WorkerWatch& watch) : watch_(watch) {}
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  /// Kills all children that still run, so that none outlives this program.
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

  /// Runs until all children have ended. After the first failure or a cancel, the others get
  /// SIGTERM after 3 s and SIGKILL after 6 s.
  void run() {
    std::optional<Clock::time_point> failed;
    while (poll_all()) {
      // `code` is 0 as long as a child runs, too, so only ended children count.
      const bool fails = std::any_of(children_.begin(), children_.end(),
                                     [](const Child& one) { return one.code != 0; });
      if (!fails && !stopped_) continue;
      if (!failed) failed = Clock::now();
      const auto since = Clock::now() - *failed;
      // A child that lost its partner ends by itself within the grace. A signal would hide its own
      // report.
      if (since > grace) end_all(since > 2 * grace ? SIGKILL : SIGTERM);
    }
  }

  // The order of the tests matters: a cancel also makes children fail, but is no failure of theirs.
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
  static constexpr int lost_another = 4;  // exit code of kinalign-learn after another process was
                                          // lost

  /// Reads from all children with output, for at most 200 ms. False: all have ended.
  bool poll_all() {
    std::vector<pollfd> waits;
    std::vector<Child*> whose;
    // A child whose output has ended has been waited for, so it needs no poll.
    for (Child& child : children_) {
      if (child.out < 0) continue;
      waits.push_back({child.out, POLLIN, 0});
      whose.push_back(&child);
    }
    if (waits.empty()) return false;
    // A timeout or a signal is no end. The caller checks its clock and calls again.
    if (::poll(waits.data(), waits.size(), 200) <= 0) return true;
    for (std::size_t i = 0; i < waits.size(); ++i) {
      if (waits[i].revents == 0) continue;
      for (const std::string& line : read_lines(*whose[i])) take(*whose[i], line);
    }
    return true;
  }

  // Handles one line of JSON: a warning, a progress report, a row or the result. Only the first
  // child's lines are reported.
  void take(Child& child, const std::string& line) {
    // Text of libraries on stdout is no JSON. It is ignored.
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
    // A progress report has "done". Every other object is a row, also the result.
    if (!json.contains("done")) {
      if (watch_.row && !json.contains("error")) watch_.row(line);
      return;
    }
    // After a cancel, late reports must not start the progress line again.
    if (stopped_) return;
    stopped_ = !go_on(watch_.progress, json.value("what", ""), json.value("done", std::uint64_t{0}),
                      json.value("total", std::uint64_t{0}));
    if (stopped_) end_all(SIGTERM);
  }

  void end_all(int signal) {
    // A child without output has been waited for. Its id may belong to another process by now.
    for (Child& child : children_) {
      if (child.out < 0) continue;
      ::kill(child.id, signal);
      child.was_ended = true;
    }
  }

  /// The child that caused the failure: if possible one that neither this program nor the loss of
  /// another process ended.
  const Child* first_to_fail() const {
    const Child* out = nullptr;
    for (const Child& child : children_) {
      if (child.code == 0) continue;
      // Signals of this program and the loss of a partner are consequences. The cause is a child
      // that failed by itself.
      const bool by_itself = !child.was_ended && child.code != lost_another;
      if (out == nullptr || (by_itself && out->code == lost_another) ||
          (by_itself && out->was_ended)) {
        out = &child;
      }
    }
    return out;
  }

  // The error that the child reported, else its exit code or signal.
  Error error_of(const Child& child) const {
    const auto json = nlohmann::json::parse(child.last, nullptr, false);
    // The error that the child wrote has a file and an expectation. It is better than an exit code.
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
  // The destructor kills the children that were started if a later one can't be.
  Workers workers(watch);
  for (const std::string& file : job_files) KA_TRY(workers.add(program, file));
  workers.run();
  return workers.result();
}

Result<std::uint16_t> free_port() {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  // Port 0 of bind() lets the system choose. Closing the socket frees the port for the worker.
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t length = sizeof address;
  const bool found =
      socket >= 0 &&
      ::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &length) == 0;
  // errno is kept before close() may change it.
  const std::string fault = std::strerror(errno);
  if (socket >= 0) ::close(socket);
  if (found) return ntohs(address.sin_port);
  return Failure(Error{"", 0, "a free port of this machine", fault});
}

Result<std::string> run_worker(const std::string& job_file, const WorkerWatch& watch) {
  return run_workers({job_file}, watch);
}

}  // namespace kinalign
