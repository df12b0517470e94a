// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/console.h"

#include "apps/kinalign/terminal.h"
#include "tests/apps/fake_verb.h"

#include <doctest/doctest.h>
#include <fcntl.h>

#include <algorithm>
#include <array>
#include <csignal>
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
        "one\n\x1b[31mtwo\x1b[0m\nthree"
        "\r\x1b[2A\x1b[Jfour\nfive"
        "\r\x1b[1A\x1b[Ja note\n\a" +
            std::string(79, 'x') + "\r\x1b[K");
  CHECK(terminal.run(job, {"mix", "a", "-q"}).err.empty());
}

TEST_CASE("no more lines are shown than a terminal has room for, nor half a character") {
  const auto job = [](Mix&, Call& call) -> Result<int> {
    const std::vector<std::pair<std::string, Colour>> lines(100, {"x", Colour::plain});
    call.console.show(lines);
    return 0;
  };
  const std::string err = Machine{.err_is_terminal = true}.run(job, {"mix", "a"}).err;
  CHECK(std::count(err.begin(), err.end(), 'x') == 23);  // of 24 rows
  CHECK(first_places("a\u00b1b", 2) == "a\u00b1");
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
