// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/take/guarded.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <vector>

using namespace kinalign;

namespace {

const Error blame{"take.h5", 0, "a take that HDF5 can read", ""};

std::string outcome(const GuardLimits& limits, const std::function<Result<std::string>()>& work) {
  const auto result = run_guarded(limits, blame, work);
  // No child process is left, running or dead.
  CHECK(::waitpid(-1, nullptr, WNOHANG) == -1);
  return result ? *result : to_string(result.error());
}

#ifdef KINALIGN_SANITIZED
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

}  // namespace

TEST_CASE("the result of work in a child comes back, however large") {
  CHECK(outcome({}, []() -> Result<std::string> { return std::string("hello"); }) == "hello");
  CHECK(outcome({}, []() -> Result<std::string> { return std::string(); }).empty());
  std::string large(50'000'001, 'x');
  for (std::size_t i = 0; i < large.size(); ++i) large[i] = static_cast<char>(i * i % 251);
  CHECK((outcome({}, [&]() -> Result<std::string> { return large; }) == large));
}

TEST_CASE("an error of work in a child comes back unchanged") {
  const auto result = run_guarded({}, blame, []() -> Result<std::string> {
    return Failure(Error{"walk.bvh", 142, "354 values in the frame", "353"});
  });
  REQUIRE_FALSE(result);
  CHECK(to_string(result.error()) == "walk.bvh:142: expected 354 values in the frame, found 353");
}

TEST_CASE("an error of work in a child keeps its kind") {
  for (const ErrorKind kind : {ErrorKind::other, ErrorKind::directory, last_error_kind}) {
    const auto result = run_guarded({}, blame, [kind]() -> Result<std::string> {
      return Failure(Error{"take.h5", 0, "a regular file", "a directory", kind});
    });
    REQUIRE_FALSE(result);
    CHECK(result.error().kind == kind);
  }
}

TEST_CASE("a crash in a child is an error") {
  CHECK(outcome({},
                []() -> Result<std::string> {
                  std::signal(SIGSEGV, SIG_DFL);
                  std::raise(SIGSEGV);
                  return std::string();
                }) ==
        "take.h5: expected a take that HDF5 can read, found a file on which the library crashed "
        "(signal 11)");
  CHECK(outcome({}, []() -> Result<std::string> { std::_Exit(0); }) ==
        "take.h5: expected a take that HDF5 can read, found a file that ended the program that "
        "read it");
}

TEST_CASE("an endless loop in a child is ended by processor time or by the clock") {
  GuardLimits limits;
  limits.cpu_seconds = 1;
  const auto spin = []() -> Result<std::string> {
    for (;;) std::atomic_signal_fence(std::memory_order_seq_cst);
  };
  CHECK(outcome(limits, spin) ==
        "take.h5: expected a take that HDF5 can read, found a file that took more than 1 s of "
        "processor time");
  limits.cpu_seconds = 600;
  limits.wall_seconds = 1;
  CHECK(outcome(limits, []() -> Result<std::string> {
          for (;;) ::pause();
        }) == "take.h5: expected a take that HDF5 can read, found a file that took more than 1 s");
}

TEST_CASE("a child that wants too much memory is an error" * doctest::skip(sanitized) *
          doctest::description("a sanitizer's own memory goes beyond any limit")) {
  GuardLimits limits;
  limits.memory_bytes = std::uint64_t{256} << 20;
  CHECK(outcome(limits,
                []() -> Result<std::string> {
                  std::vector<std::string> hoard;
                  for (;;) hoard.emplace_back(1 << 20, 'x');
                }) ==
        "take.h5: expected a take that HDF5 can read, found a file that needs more than 256 MiB of "
        "memory");
}

TEST_CASE("a child that sends what no child of ours sends is ended, though it would go on") {
  const std::function<Result<std::string>()> babble = []() -> Result<std::string> {
    // The pipe to us is one that no other program inherits.
    for (int pipe = 3; pipe < 1024; ++pipe) {
      struct stat facts {};
      if (::fstat(pipe, &facts) != 0 || !S_ISFIFO(facts.st_mode)) continue;
      if ((::fcntl(pipe, F_GETFD) & FD_CLOEXEC) == 0) continue;
      const std::string noise(1 << 20, '\xff');
      while (::write(pipe, noise.data(), noise.size()) > 0) {
      }
    }
    for (;;) ::pause();
  };
  GuardLimits limits;
  limits.wall_seconds = 20;
  CHECK(outcome(limits, babble) ==
        "take.h5: expected a take that HDF5 can read, found a file whose result was too long");
}

TEST_CASE("more output than wanted ends the child") {
  GuardLimits limits;
  limits.output_bytes = 1000;
  CHECK(
      outcome(limits, []() -> Result<std::string> { return std::string(1 << 24, 'x'); }) ==
      "take.h5: expected a take that HDF5 can read, found a file whose contents exceed 1000 bytes");
}

TEST_CASE("what a child sends arrives in order, piece by piece") {
  std::string got;
  int pieces = 0;
  const auto done = run_guarded(
      {}, blame,
      [](const GuardSend& send) -> Result<void> {
        for (int i = 0; i < 1000; ++i) KA_TRY(send(std::to_string(i) + " "));
        return Failure(Error{"", 0, "more", "the end"});
      },
      [&](std::string_view piece) -> Result<void> {
        got += piece;
        ++pieces;
        return {};
      });
  std::string all;
  for (int i = 0; i < 1000; ++i) all += std::to_string(i) + " ";
  CHECK(got == all);
  CHECK(pieces == 1000);
  REQUIRE_FALSE(done);
  CHECK(to_string(done.error()) == "expected more, found the end");
}
