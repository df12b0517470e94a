// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/outlet.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>

using namespace kinalign;

namespace {

/// A pipe of 4 KiB.
class Pipe {
 public:
  Pipe() {
    REQUIRE(::pipe2(ends_.data(), O_CLOEXEC) == 0);
    ::fcntl(ends_[1], F_SETPIPE_SZ, 4096);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    ::close(ends_[1]);
    stop_reading();
  }
  int in() const { return ends_[1]; }
  std::string read() {
    std::string text(1U << 20U, '\0');
    const ssize_t got = ::read(ends_[0], text.data(), text.size());
    return text.substr(0, got > 0 ? static_cast<std::size_t>(got) : 0);
  }
  void stop_reading() {
    if (ends_[0] >= 0) ::close(ends_[0]);
    ends_[0] = -1;
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

}  // namespace

TEST_CASE("what is put is written in order, at the latest when it is flushed") {
  Pipe pipe;
  Outlet outlet(pipe.in());
  outlet.put("one\n");
  outlet.put("two\n");
  CHECK(outlet.holds());
  outlet.flush();
  CHECK(!outlet.holds());
  CHECK(pipe.read() == "one\ntwo\n");
}

TEST_CASE("a blocked terminal is not waited for") {
  int master = -1, slave = -1;
  REQUIRE(::openpty(&master, &slave, nullptr, nullptr, nullptr) == 0);
  termios raw{};
  ::cfmakeraw(&raw);
  ::tcsetattr(slave, TCSANOW, &raw);
  {
    Outlet outlet(slave);
    outlet.never_wait();
    for (int i = 0; i < 100; ++i) {
      outlet.put(std::string(999, 'x') + "\n");
      outlet.flush();
    }
    CHECK(outlet.holds());
    CHECK(outlet.fault() == 0);
    std::size_t read = 0;
    std::array<char, 4096> text{};
    while (outlet.holds() || read < 100'000) {
      const ssize_t got = ::read(master, text.data(), text.size());
      if (got <= 0) break;
      read += static_cast<std::size_t>(got);
      outlet.flush(std::chrono::milliseconds{10});
    }
    CHECK(read == 100'000);
  }
  // Other users of the terminal keep their blocking mode.
  CHECK((::fcntl(slave, F_GETFL) & O_NONBLOCK) == 0);
  ::close(master);
  ::close(slave);
}

TEST_CASE("a reader that does not read is not waited for, and what it misses is counted") {
  Pipe pipe;
  Outlet outlet(pipe.in());
  outlet.never_wait();
  const std::string line = std::string(999, 'x') + "\n";
  for (int i = 0; i < 2000; ++i) {
    outlet.put(line);
    outlet.flush();
  }
  CHECK(outlet.take_dropped() == 0);  // there is no room yet to report them
  std::string read;
  while (outlet.holds()) {
    read += pipe.read();
    outlet.flush();
  }
  read += pipe.read();
  const std::uint64_t dropped = outlet.take_dropped();
  CHECK(read.size() % line.size() == 0);  // whole lines
  CHECK(read.size() / line.size() + dropped == 2000);
  CHECK(dropped > 900);  // only 1 MiB and the pipe's content were kept
  CHECK(outlet.take_dropped() == 0);
  outlet.put("on\n");
  outlet.flush();
  CHECK(pipe.read() == "on\n");
}

TEST_CASE("a reader that went away is a fault, and nothing is held for it") {
  std::signal(SIGPIPE, SIG_IGN);
  Pipe pipe;
  for (const bool waits : {true, false}) {
    Outlet outlet(pipe.in());
    if (!waits) outlet.never_wait();
    pipe.stop_reading();
    outlet.put("one\n");
    outlet.flush();
    CHECK(outlet.fault() == EPIPE);
    CHECK(!outlet.holds());
  }
}

TEST_CASE("a full disk is a fault, and what it did not take is written once it has room") {
  const int fd = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
  Outlet outlet(fd);
  outlet.never_wait();
  outlet.put("one\n");
  outlet.flush();
  CHECK(outlet.fault() == ENOSPC);
  CHECK(!outlet.gave_up());
  CHECK(outlet.holds());
  Pipe pipe;
  REQUIRE(::dup2(pipe.in(), fd) == fd);  // the pipe has room
  outlet.put("two\n");
  outlet.flush();
  CHECK(outlet.fault() == 0);
  CHECK(!outlet.holds());
  CHECK(pipe.read() == "one\ntwo\n");
  ::close(fd);
}
