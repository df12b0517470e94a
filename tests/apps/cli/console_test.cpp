// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"

#include "apps/cli/terminal.h"
#include "tests/apps/cli/fake_verb.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>

using namespace kinalign;

namespace {

Result<int> speak(Mix& /*options*/, Call& call) {
  call.console.print("a result, " + call.console.paint(Colour::bad, "red") + "\n");
  call.console.note("a note");
  call.console.detail("a detail");
  call.console.print_json(R"({"frames": 3})", 2);
  return 0;
}

Result<int> fail(Mix& /*options*/, Call& call) {
  call.console.if_it_fails([](const Error& error) {
    return std::vector<std::string>{"nothing was written",
                                    "kinalign check " + error.file + " lists everything"};
  });
  return Failure(Error{"walk.bvh", 142, "354 values in the frame", "353"});
}

/// Moves to the line above and erases it. Why it is erased separately: see start_of_lines().
const std::string up = "\x1b[A\x1b[K";

/// A terminal whose size can be changed, and the text that was shown on it.
class Pty {
 public:
  Pty() : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    REQUIRE(::grantpt(master_) == 0);
    REQUIRE(::unlockpt(master_) == 0);
    std::array<char, 64> name{};
    REQUIRE(::ptsname_r(master_, name.data(), name.size()) == 0);
    slave_ = ::open(name.data(), O_RDWR | O_NOCTTY);
    REQUIRE(slave_ >= 0);
  }
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;
  ~Pty() {
    ::close(slave_);
    ::close(master_);
  }
  int slave() const { return slave_; }
  void resize(std::uint16_t columns) const {
    const winsize size{24, columns, 0, 0};
    REQUIRE(::ioctl(master_, TIOCSWINSZ, &size) == 0);
  }
  /// The text that was shown since the last call. The kernel carries it over in its own time, so a
  /// mark is written behind it and waited for.
  std::string shown() const {
    const char mark = '\x01';
    REQUIRE(::write(slave_, &mark, 1) == 1);
    std::string text;
    for (char byte = 0; byte != mark;) {
      pollfd readable{master_, POLLIN, 0};
      REQUIRE(::poll(&readable, 1, 10'000) == 1);
      REQUIRE(::read(master_, &byte, 1) == 1);
      if (byte != mark) text += byte;
    }
    return text;
  }

 private:
  int master_, slave_ = -1;
};

}  // namespace

TEST_CASE("results go to stdout, everything else to stderr") {
  const Outcome outcome = Machine{}.run(speak, {"mix", "a"});
  CHECK(outcome.out == "a result, red\n");
  CHECK(outcome.err == "a note\n");
  CHECK(Machine{}.run(speak, {"mix", "a", "-v"}).err == "a note\na detail\n");
}

TEST_CASE("--quiet leaves errors only") {
  const Outcome outcome = Machine{}.run(speak, {"mix", "a", "-q"});
  CHECK(outcome.out.empty());
  CHECK(outcome.err.empty());
  CHECK_FALSE(Machine{}.run(fail, {"mix", "a", "-q"}).err.empty());
}

TEST_CASE("--json prints one object with its schema and nothing else on stdout") {
  const Outcome outcome = Machine{}.run(speak, {"mix", "a", "--json"});
  CHECK(outcome.out == "{\"schema\": \"kinalign.mix/2\", \"frames\": 3}\n");
  const auto empty = [](Mix&, Call& call) -> Result<int> {
    call.console.print_json("{}");
    return 0;
  };
  CHECK(Machine{}.run(empty, {"mix", "a", "--json"}).out == "{\"schema\": \"kinalign.mix/1\"}\n");
}

TEST_CASE("a job knows whether anybody reads its JSON, and need not make it else") {
  const auto job = [](Mix&, Call& call) -> Result<int> {
    return call.console.prints_json() ? 0 : 1;
  };
  CHECK(Machine{}.run(job, {"mix", "a", "--json"}).code == 0);
  CHECK(Machine{}.run(job, {"mix", "a"}).code == 1);
}

TEST_CASE("colour stands on a terminal without NO_COLOR, or where it was asked for") {
  const std::string red = "a result, \x1b[31mred\x1b[0m\n";
  const std::string plain = "a result, red\n";
  const Machine terminal{.out_is_terminal = true};
  const Machine no_colour{.variables = {{"NO_COLOR", "1"}}, .out_is_terminal = true};
  CHECK(terminal.run(speak, {"mix", "a"}).out == red);
  CHECK(terminal.run(speak, {"mix", "a", "--color=never"}).out == plain);
  CHECK(no_colour.run(speak, {"mix", "a"}).out == plain);
  CHECK(no_colour.run(speak, {"mix", "a", "--color=always"}).out == red);
  CHECK(Machine{}.run(speak, {"mix", "a", "--color=always"}).out == red);
}

TEST_CASE("an error says what, where, and what to do next, and the exit code is 3") {
  const Outcome outcome = Machine{}.run(fail, {"mix", "a"});
  CHECK(outcome.code == 3);
  CHECK(outcome.out.empty());
  CHECK(outcome.err ==
        "kinalign mix: walk.bvh:142: expected 354 values in the frame, found 353\n"
        "  nothing was written\n"
        "  kinalign check walk.bvh lists everything\n");
}

TEST_CASE("the progress line stands on a terminal only and is gone when the job is done") {
  const auto job = [](Mix&, Call& call) -> Result<int> {
    go_on(call.console.progress(), "reading", 1, 4);
    return 0;
  };
  CHECK(Machine{}.run(job, {"mix", "a"}).err.empty());
  const Machine terminal{.err_is_terminal = true};
  CHECK(terminal.run(job, {"mix", "a"}).err == "\r\x1b[Kreading  25 %\r\x1b[K");
  CHECK(terminal.run(job, {"mix", "a", "-q"}).err.empty());
}

TEST_CASE("a progress line never stands within JSON on the same terminal") {
  const auto job = [](Mix&, Call& call) -> Result<int> {
    go_on(call.console.progress(), "reading", 1, 4);
    call.console.print_json("{}");
    return 0;
  };
  const Machine terminal{.out_is_terminal = true, .err_is_terminal = true};
  CHECK(terminal.run(job, {"mix", "a", "--json"}).err.empty());
  CHECK_FALSE(terminal.run(job, {"mix", "a"}).err.empty());
  CHECK_FALSE(Machine{.err_is_terminal = true}.run(job, {"mix", "a", "--json"}).err.empty());
}

TEST_CASE(
    "lines that are shown stand on a terminal only, over those before, and are gone in the end") {
  const auto job = [](Mix&, Call& call) -> Result<int> {
    call.console.show({{"one", Colour::plain}, {"two", Colour::bad}, {"three", Colour::plain}});
    call.console.show({{"four", Colour::plain}, {"five", Colour::plain}});
    call.console.note("a note");
    call.console.ring();
    call.console.show({{std::string(100, 'x'), Colour::plain}});
    return 0;
  };
  CHECK(Machine{}.run(job, {"mix", "a"}).err == "a note\n");
  const Machine terminal{.err_is_terminal = true};
  CHECK(terminal.run(job, {"mix", "a"}).err ==
        "one\n\x1b[31mtwo\x1b[0m\nthree\r\x1b[K" + up + up + "four\nfive\r\x1b[K" + up +
            "a note\nfour\nfive\a\r\x1b[K" + up + std::string(79, 'x') + "\r\x1b[K");
  CHECK(terminal.run(job, {"mix", "a", "-q"}).err.empty());
}

TEST_CASE("messages printed while status lines are shown stand above them, also from stdout") {
  const auto job = [](Mix&, Call& call) -> Result<int> {
    call.console.show({{"a line", Colour::plain}});
    call.console.note("a note");
    call.console.complain("trouble");
    call.console.print("a result\n");
    call.console.flush();
    call.console.print("another\n");
    call.console.note("a note");
    return Failure(Error{"", 0, "an end", "none"});
  };
  const std::string again = "a line\r\x1b[K";
  const Machine terminal{.out_is_terminal = true, .err_is_terminal = true};
  const Outcome outcome = terminal.run(job, {"mix", "a"});
  CHECK(outcome.out == "a result\nanother\n");
  CHECK(outcome.err == again + "a note\n" + again + "\x1b[31mtrouble\x1b[0m\n" + again + again +
                           "a note\n" + again +
                           "\x1b[31mkinalign mix: expected an end, found none\x1b[0m\n" + again);
  CHECK(Machine{.err_is_terminal = true}.run(job, {"mix", "a", "--color=never"}).err ==
        again + "a note\n" + again + "trouble\n" + again + "a note\n" + again +
            "kinalign mix: expected an end, found none\n" + again);  // no results stand there
}

TEST_CASE("lines wrapped by a narrower terminal are erased, too") {
  Pty pty;
  pty.resize(80);
  PosixFiles files;
  const Surroundings surroundings{.variable = [](const std::string&) { return std::string(); },
                                  .folder = "/",
                                  .out = pty.slave(),
                                  .err = pty.slave(),
                                  .out_is_terminal = true,
                                  .err_is_terminal = true,
                                  .files = files};
  Common common;
  common.color = "always";
  Console console(surroundings, common, "mix");
  console.show(
      {{std::string(41, 'x'), Colour::bad}, {"", Colour::plain}, {"three", Colour::plain}});
  CHECK(pty.shown() == "\x1b[31m" + std::string(41, 'x') + "\x1b[0m\r\n\r\nthree");
  pty.resize(20);
  console.note("a note");
  const std::string narrow = "\x1b[31m" + std::string(19, 'x') + "\x1b[0m\r\n\r\nthree";
  CHECK(pty.shown() ==
        // The lines took three rows, one and one.
        "\r\x1b[K" + up + up + up + up + "a note\r\n" + narrow);
  console.show(
      {{std::string(19, 'x'), Colour::bad}, {"", Colour::plain}, {"three", Colour::plain}});
  CHECK(pty.shown() == "\r\x1b[K" + up + up + narrow);
  go_on(console.progress(), "reading so much of so many files", 1, 4);
  CHECK(pty.shown() == "\r\x1b[K" + up + up + "reading so much of ");
  pty.resize(10);
  console.print("a result\n");
  CHECK(console.finish());
  CHECK(pty.shown() == "\r\x1b[K" + up + "a result\r\n");
  CHECK(rows_of(0, 20) == 1);
  CHECK(rows_of(20, 20) == 1);
  CHECK(rows_of(21, 20) == 2);
}

TEST_CASE("no more lines are shown than a terminal has room for, nor half a character") {
  const auto job = [](Mix&, Call& call) -> Result<int> {
    const std::vector<std::pair<std::string, Colour>> lines(100, {"x", Colour::plain});
    call.console.show(lines);
    CHECK(call.console.rows() == 23);
    return 0;
  };
  const std::string err = Machine{.err_is_terminal = true}.run(job, {"mix", "a"}).err;
  CHECK(std::count(err.begin(), err.end(), 'x') == 23);  // the terminal has 24 rows
  CHECK(first_places("a\u00b1b", 2) == "a\u00b1");
}

TEST_CASE(
    "tmux keeps no copy of the screen for each table: nothing is erased to the screen's end") {
  for (std::size_t lines = 1; lines < 50; ++lines) {
    CHECK(start_of_lines(lines).find("\x1b[J") == std::string::npos);
    CHECK(start_of_lines(lines).size() == 4 + 6 * (lines - 1));
  }
}

TEST_CASE("the progress line gives rate and time left, cut to the terminal") {
  CHECK(progress_line("reading", 250'000'000, 1'000'000'000, 2.0, 80) ==
        "reading  25 %  125.0 MB/s  6 s left");
  CHECK(progress_line("aligning", 100, 36'000, 10.0, 80) ==
        "aligning  0 %  10 frames/s  1 h 00 min left");
  CHECK(progress_line("reading", 5, 0, 0.1, 80) == "reading");
  CHECK(progress_line("reading", 250'000'000, 1'000'000'000, 2.0, 12) == "reading  25 ");
}

TEST_CASE("long lines are broken on a terminal, below the second column, and nowhere else") {
  const std::string red = "\x1b[31mthree\x1b[0m";
  CHECK(broken("  space  one two " + red + " four\nshort\n", 30) ==
        "  space  one two " + red + " four\nshort\n");
  CHECK(broken("  space  one two " + red + " ± ± four five six\n", 30) ==
        "  space  one two " + red + " ± ±\n         four five six\n");
  CHECK(broken("one two three four five six seven\n", 24) ==
        "one two three four five\n  six seven\n");
  CHECK(broken("no_blank_at_all_in_this_one_long_word\n", 30) ==
        "no_blank_at_all_in_this_one_long_word\n");
  const auto job = [](Mix&, Call& call) -> Result<int> {
    call.console.print("word " + std::string(60, 'x') + " " + std::string(60, 'y') + "\n");
    return 0;
  };
  CHECK(Machine{.out_is_terminal = true}.run(job, {"mix", "a"}).out ==
        "word " + std::string(60, 'x') + "\n  " + std::string(60, 'y') + "\n");
  const auto fails = [](Mix&, Call&) -> Result<int> {
    return Failure(Error{"", 0, std::string(70, 'x'), "y"});
  };
  CHECK(Machine{.err_is_terminal = true}.run(fails, {"mix", "a"}).err ==
        "\x1b[31mkinalign mix: expected\n  " + std::string(70, 'x') + ", found\n  y\x1b[0m\n");
  CHECK(Machine{}.run(job, {"mix", "a"}).out.find(" y") != std::string::npos);
}

TEST_CASE("Ctrl-C stops a job through its progress and leaves no half file") {
  const auto folder =
      std::filesystem::temp_directory_path() / ("kinalign_stop_" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  const auto job = [&](Mix&, Call& call) -> Result<int> {
    auto file =
        KA_TRY(OutputFile::create(call.surroundings.files, (folder / "t").string(), Overwrite::no));
    KA_TRY(file.write("half"));
    const Progress progress = call.console.progress();
    CHECK(go_on(progress, "reading", 1, 4));
    std::raise(SIGINT);
    if (!go_on(progress, "reading", 2, 4)) return Failure(Error{"", 0, "to go on", "Ctrl-C"});
    KA_TRY(file.commit());
    return 0;
  };
  const Outcome outcome = Machine{}.run(job, {"mix", "a"});
  CHECK(outcome.code == 130);
  CHECK(outcome.err == "kinalign mix: stopped; no unfinished file is left\n");
  CHECK(std::filesystem::is_empty(folder));
  std::filesystem::remove_all(folder);
}

TEST_CASE("a reader of stdout that goes away ends the output quietly") {
  std::array<int, 2> ends{};
  REQUIRE(::pipe(ends.data()) == 0);
  ::close(ends[0]);
  const Outcome outcome = Machine{.out = ends[1]}.run(speak, {"mix", "a"});
  ::close(ends[1]);
  CHECK(outcome.code == 0);
  CHECK(outcome.err == "a note\n");
}

TEST_CASE("a full disk behind stdout is an error of output") {
  const int full = ::open("/dev/full", O_WRONLY);
  REQUIRE(full >= 0);
  const Outcome outcome = Machine{.out = full}.run(speak, {"mix", "a"});
  ::close(full);
  CHECK(outcome.code == 3);
  CHECK(outcome.err ==
        "a note\n"
        "kinalign mix: standard output: expected room to write, found No space left on device\n");
}
