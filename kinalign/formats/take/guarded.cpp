// SPDX-License-Identifier: Apache-2.0
// The child process sends messages to the parent process. A message has a letter ('d' data, 'p'
// progress, 'e' an error, '.' done), its length in four bytes, and its content. The parent accepts
// at most `message_most` bytes of content.
#include "kinalign/formats/take/guarded.h"

#include "kinalign/core/file_calls.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <new>
#include <optional>

namespace kinalign {

namespace {

// 1 MiB. The limit keeps a damaged child from making the parent allocate more.
constexpr std::size_t message_most = std::size_t{1} << 20;
constexpr std::size_t head_size = 5;
// The exit code of a child that has no more memory.
constexpr int no_memory_code = 77;

// ---- The child process.

bool write_all(int pipe, std::string_view bytes) {
  return put_all(bytes, [pipe](std::string_view rest) {
           return ::write(pipe, rest.data(), rest.size());
         }) == 0;
}

/// Sends a message in two writes, one for the head and one for the content.
bool send(int pipe, char kind, std::string_view bytes) {
  char head[head_size] = {kind};
  const auto size = static_cast<std::uint32_t>(bytes.size());
  std::memcpy(head + 1, &size, sizeof size);
  return write_all(pipe, {head, head_size}) && write_all(pipe, bytes);
}

/// Converts an error to the content of a message: its parts with NUL characters between them.
std::string packed(const Error& error) {
  std::string out =
      std::to_string(error.line) + '\0' + std::to_string(static_cast<int>(error.kind));
  for (const std::string* text : {&error.file, &error.expected, &error.found}) {
    // Long texts are cut, so that all five parts together are shorter than message_most.
    out += '\0' + text->substr(0, message_most / 8);
  }
  return out;
}

/// The bytes of address space that the process uses. RLIMIT_AS limits the whole address space, so
/// the limit must include what the parent used before.
/// before.
[[maybe_unused]] rlim_t mapped_bytes() {
  unsigned long pages = 0;
  std::FILE* file = std::fopen("/proc/self/statm", "re");
  if (file == nullptr) return 0;
  if (std::fscanf(file, "%lu", &pages) != 1) pages = 0;
  std::fclose(file);
  return static_cast<rlim_t>(pages) * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

/// Sets a limit. A limit can't be raised above the present hard limit of the process.
void limit(__rlimit_resource what, rlim_t soft, rlim_t hard) {
  rlimit now{};
  ::getrlimit(what, &now);
  const rlimit wanted{std::min(soft, now.rlim_max), std::min(hard, now.rlim_max)};
  ::setrlimit(what, &wanted);
}

void set_limits(const GuardLimits& limits) {
  // No core file is written, because a crash is expected and the file may be private.
  limit(RLIMIT_CORE, 0, 0);
  // The soft limit sends SIGXCPU, which shows the cause. A second later the hard limit sends
  // SIGKILL.
  limit(RLIMIT_CPU, limits.cpu_seconds, limits.cpu_seconds + 1);
#ifndef KINALIGN_SANITIZED  // sanitizers reserve terabytes of address space
  const rlim_t memory = mapped_bytes() + limits.memory_bytes;
  limit(RLIMIT_AS, memory, memory);
#endif
  // A lack of memory ends the child at once with a special exit code.
  std::set_new_handler([] { ::_exit(no_memory_code); });
}

/// Resets signals to their default, so that a crash or Ctrl-C ends the child, whatever the parent
/// does with these signals.
void reset_signals() {
  for (const int number : {SIGINT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU}) {
    ::signal(number, SIG_DFL);
  }
  // If the parent has ended, write() now fails with EPIPE instead of a signal.
  ::signal(SIGPIPE, SIG_IGN);
}

// The general form of the work. The three forms of run_guarded() convert to it.
using Work = std::function<Result<void>(const GuardSend&, const Progress&)>;
using Receive = std::function<Result<void>(std::string_view)>;

/// The progress of a job, sent as the content of a message.
struct Step {
  std::uint64_t done = 0, total = 0;
};

std::string packed(const Step& step, std::string_view what) {
  std::string out(sizeof step, '\0');
  std::memcpy(out.data(), &step, sizeof step);
  return out.append(what.substr(0, message_most / 8));
}

/// Runs the work in the child, sends the result, and ends the process.
[[noreturn]] void run_child(int pipe, const GuardLimits& limits, const Work& work) {
  // If the parent dies, the system kills the child.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The limits are set before any byte of the file is read.
  reset_signals();
  set_limits(limits);
  // Data that are longer than a message are sent in several messages.
  const GuardSend send_data = [pipe](std::string_view bytes) -> Result<void> {
    for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), message_most))) {
      if (!send(pipe, 'd', bytes.substr(0, message_most))) {
        return refuse("a process that reads the result", "no such process");
      }
    }
    return {};
  };
  const Progress child_progress = [pipe](std::string_view what, std::uint64_t done,
                                         std::uint64_t total) {
    return send(pipe, 'p', packed(Step{done, total}, what));
  };
  // An exception that is not caught aborts the child. The parent reports this as a crash.
  const Result<void> done = work(send_data, child_progress);
  const bool is_sent = done ? send(pipe, '.', "") : send(pipe, 'e', packed(done.error()));
  ::_exit(is_sent ? 0 : 1);  // skips destructors and buffers of the parent
}

// ---- The parent process.

/// Owns the child process: kills it if it still runs, and keeps its exit status. All paths out of
/// run() destroy the Child object, so no process and no descriptor stays open.
class Child {
 public:
  Child(pid_t id, int pipe) : id_(id), pipe_(pipe) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    ::close(pipe_);
    if (!ended_) end();
  }

  int pipe() const { return pipe_; }
  /// Ends the child and returns its exit status. Call this when the child has closed its pipe, or
  /// when its messages are not needed any more. A child that ends by itself does so before its pipe
  /// closes, so kill() does not change its exit status.
  int end() {
    // kill() does no harm to a child that has ended, because its id stays in use until waitpid()
    // returns.
    ::kill(id_, SIGKILL);
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    ended_ = true;
    return status;
  }

 private:
  pid_t id_;
  int pipe_;
  bool ended_ = false;
};

/// The error in the content of a message from packed(). Any bytes are accepted, because the child
/// may be damaged.
Error unpacked(std::string_view bytes) {
  Error error;
  std::string line, kind;
  for (std::string* text : {&line, &kind, &error.file, &error.expected, &error.found}) {
    const auto end = std::min(bytes.find('\0'), bytes.size());
    *text = bytes.substr(0, end);
    bytes.remove_prefix(std::min(end + 1, bytes.size()));
  }
  error.line = std::strtoll(line.c_str(), nullptr, 10);
  // An unknown number gives ErrorKind::other.
  const unsigned long number = std::strtoul(kind.c_str(), nullptr, 10);
  if (number <= static_cast<unsigned long>(last_error_kind)) {
    error.kind = static_cast<ErrorKind>(number);
  }
  return error;
}

// An error about the child, with file and `expected` from `blame`. The kind of `blame` belongs to
// another error and is not used.
Error blamed(const Error& blame, const std::string& found) {
  return {blame.file, blame.line, blame.expected, found};
}

/// Describes the end of a child that sent no error. Only its exit status is known.
std::string cause(int status, const GuardLimits& limits) {
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    if (number == SIGXCPU) {
      return "a file that took more than " + std::to_string(limits.cpu_seconds) +
             " s of processor time";
    }
    return "a file on which the library crashed (signal " + std::to_string(number) + ")";
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == no_memory_code) {
    return "a file that needs more than " + std::to_string(limits.memory_bytes >> 20) +
           " MiB of memory";
  }
  return "a file that ended the program that read it";
}

/// Splits the received bytes into messages. A hostile file may control the child, so every message
/// is checked: the length is limited, and only known letters are accepted.
class Inbox {
 public:
  Inbox(const Receive& receive, const Progress& progress)
      : receive_(receive), progress_(progress) {}

  /// Takes the next bytes. Returns false if a message is not valid.
  Result<bool> take(std::string_view bytes) {
    pending_ += bytes;
    std::size_t at = 0;
    while (pending_.size() - at >= head_size) {
      std::uint32_t size = 0;
      std::memcpy(&size, pending_.data() + at + 1, sizeof size);
      // After a wrong length, the following bytes have no known meaning.
      if (size > message_most) {
        strange_ = true;
        return false;
      }
      if (pending_.size() - at < head_size + size) break;
      const auto body = std::string_view(pending_).substr(at + head_size, size);
      const char kind = pending_[at];
      // `receive` runs in the parent, so its error is returned directly.
      if (kind == 'd') KA_TRY(receive_(body));
      if (kind == 'p' && !pass_on(body)) return Failure(interruption());
      if (kind == 'e') error_ = unpacked(body);
      if (kind == '.') done_ = true;
      at += head_size + size;
    }
    pending_.erase(0, at);
    return true;
  }

  bool done() const { return done_; }
  bool strange() const { return strange_; }
  /// The last error that the child sent; empty if there was none.
  const std::optional<Error>& error() const { return error_; }

 private:
  /// Passes on a progress report. Returns false if the user stops the job.
  bool pass_on(std::string_view body) const {
    Step step;
    if (body.size() < sizeof step) return true;
    std::memcpy(&step, body.data(), sizeof step);
    return go_on(progress_, body.substr(sizeof step), step.done, step.total);
  }

  const Receive& receive_;
  const Progress& progress_;
  std::string pending_;
  std::optional<Error> error_;
  bool done_ = false, strange_ = false;
};

/// Reads until the child closes its pipe or sends an invalid message. Returns false if the time
/// limit is reached. Fails if a signal such as Ctrl-C arrives.
Result<bool> read_until_end(const Child& child, double wall_seconds, Inbox& inbox) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  std::string buffer(std::size_t{64} << 10, '\0');
  for (;;) {
    // poll() waits for a limited time, so that the time limit is checked regularly.
    const double left = wall_seconds - std::chrono::duration<double>(Clock::now() - start).count();
    if (left <= 0) return false;
    pollfd waiting{child.pipe(), POLLIN, 0};
    const int ready = ::poll(&waiting, 1, static_cast<int>(std::min(left, 1000.0) * 1000.0) + 1);
    // The program handles this signal, which means that the user wants to stop.
    if (ready < 0 && errno == EINTR) return Failure(interruption());
    if (ready <= 0) continue;
    const ssize_t got = ::read(child.pipe(), buffer.data(), buffer.size());
    // The child has closed its pipe: it has ended or will end soon.
    if (got == 0) return true;
    if (got < 0) continue;
    const std::string_view bytes(buffer.data(), static_cast<std::size_t>(got));
    if (!KA_TRY(inbox.take(bytes))) return true;
  }
}

/// Starts the child, receives its messages, and converts an abnormal end to an error.
Result<void> run(const GuardLimits& limits, const Error& blame, const Work& work,
                 const Receive& receive, const Progress& progress) {
  int ends[2] = {-1, -1};
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    return refuse("a pipe to a child process", std::strerror(errno));
  }
  const pid_t id = ::fork();
  // This part runs in the child. run_child() does not return.
  if (id == 0) {
    ::close(ends[0]);
    run_child(ends[1], limits, work);
  }
  const int code = errno;
  // The parent closes its copy of the writing end. Otherwise reading would never reach the end.
  ::close(ends[1]);
  if (id < 0) {
    ::close(ends[0]);
    return refuse("a child process", std::strerror(code));
  }
  Child child(id, ends[0]);
  Inbox inbox(receive, progress);
  if (!KA_TRY(read_until_end(child, limits.wall_seconds, inbox))) {
    const auto seconds = static_cast<std::int64_t>(limits.wall_seconds);
    return Failure(blamed(blame, "a file that took more than " + std::to_string(seconds) + " s"));
  }
  // An error from the child is more exact than its exit status.
  if (inbox.error()) return Failure(*inbox.error());
  // If the result is complete, it counts even if the child crashes later.
  if (inbox.done()) return {};
  const int status = child.end();
  return Failure(
      blamed(blame, inbox.strange() ? "a file whose result was too long" : cause(status, limits)));
}

}  // namespace

Result<void> run_guarded(const GuardLimits& limits, const Error& blame,
                         const std::function<Result<void>(const GuardSend&)>& work,
                         const std::function<Result<void>(std::string_view)>& receive) {
  const auto silent = [&](const GuardSend& send_data, const Progress&) { return work(send_data); };
  return run(limits, blame, silent, receive, {});
}

Result<std::string> run_guarded(const GuardLimits& limits, const Error& blame,
                                const Progress& progress,
                                const std::function<Result<std::string>(const Progress&)>& work) {
  std::string text;
  const auto send_text = [&](const GuardSend& send_data,
                             const Progress& child_progress) -> Result<void> {
    const std::string result = KA_TRY(work(child_progress));
    return send_data(result);
  };
  // The limit protects the memory of the parent, which stores the text.
  const auto keep = [&](std::string_view bytes) -> Result<void> {
    if (text.size() + bytes.size() > limits.output_bytes) {
      return Failure(blamed(
          blame, "a file whose contents exceed " + std::to_string(limits.output_bytes) + " bytes"));
    }
    text += bytes;
    return {};
  };
  KA_TRY(run(limits, blame, send_text, keep, progress));
  return text;
}

Result<std::string> run_guarded(const GuardLimits& limits, const Error& blame,
                                const std::function<Result<std::string>()>& work) {
  return run_guarded(limits, blame, {}, [&](const Progress&) { return work(); });
}

}  // namespace kinalign
