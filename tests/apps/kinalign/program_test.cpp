// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/program.h"

#include "apps/cli/help.h"
#include "apps/kinalign/verbs.h"
#include "tests/apps/cli/fake_verb.h"
#include "tests/folder.h"

#include <doctest/doctest.h>

#include <chrono>

using namespace kinalign;

namespace {

/// A job that prints its options.
Result<int> show(Mix& o, Call& call) {
  call.console.print(std::to_string(static_cast<int>(o.gap_ms)) + " " + std::to_string(o.rows) +
                     " " + std::to_string(call.jobs));
  return 0;
}

/// A verb with two positionals that have choices.
struct Pour {
  std::vector<std::string> from, to;
};

Usage describe_pour(Pour& o) {
  Usage usage;
  usage.positionals = {{"FROM", "a jug", &o.from, 1, 1, {"jug"}},
                       {"TO", "a glass", &o.to, 1, 1, {"cup", "glass"}}};
  return usage;
}

Machine machine_in(const FreshFolder& folder) {
  return {.variables = {{"HOME", folder.path()}}, .folder = folder / "project/deep"};
}

}  // namespace

TEST_CASE("exit codes: 0 done, 1 findings, 2 wrong use, 3 input or output") {
  CHECK(Machine{}.run(nothing, {"mix", "a"}).code == 0);
  CHECK(Machine{}.run([](Mix&, Call&) -> Result<int> { return 1; }, {"mix", "a"}).code == 1);
  CHECK(Machine{}.run(nothing, {"mix"}).code == 2);
  const auto fail = [](Mix&, Call&) -> Result<int> { return Failure(Error{"f", 0, "a", "b"}); };
  CHECK(Machine{}.run(fail, {"mix", "a"}).code == 3);
}

TEST_CASE("an unknown verb is answered with the nearest known one") {
  const Outcome outcome = Machine{}.run(nothing, {"mxi", "a"});
  CHECK(outcome.code == 2);
  CHECK(outcome.err ==
        "kinalign: expected a known verb, found mxi\n"
        "  did you mean mix? kinalign --help lists the verbs\n");
}

TEST_CASE("a flag before the verb is refused with its right place") {
  CHECK(Machine{}
            .run(nothing, {"--json", "mix"})
            .err.starts_with("kinalign: expected a verb before its flags, found --json\n"));
}

TEST_CASE("without a verb the list of verbs goes to stderr") {
  const Outcome outcome = Machine{}.run(nothing, {});
  CHECK(outcome.code == 2);
  CHECK(outcome.out.empty());
  CHECK(outcome.err.find("mix ") != std::string::npos);
}

TEST_CASE("what only a verb's own check can see is wrong use too") {
  const Outcome outcome = Machine{}.run(nothing, {"mix", "a", "--imu", "w.csv"});
  CHECK(outcome.code == 2);
  CHECK(outcome.err ==
        "kinalign mix: --imu: expected NODE=FILE, found w.csv\n"
        "  kinalign mix --help lists its arguments and flags, with examples\n");
}

TEST_CASE("a flag wins over the environment, that over the project, that over the user") {
  const FreshFolder folder;
  Machine machine = machine_in(folder);
  const std::vector<std::string> words{"mix", "a"};
  CHECK(machine.run(show, {"mix", "a", "--jobs=1"}).out == "50 3 1");
  folder.write(".config/kinalign/config.toml", "jobs = 2\n[mix]\ngap_ms = 10\nrows = 2\n");
  CHECK(machine.run(show, words).out == "10 2 2");
  folder.write("project/kinalign.toml", "jobs = 3\n[mix]\ngap_ms = 20\n");
  CHECK(machine.run(show, words).out == "20 2 3");
  machine.variables["KINALIGN_GAP_MS"] = "30";
  machine.variables["KINALIGN_JOBS"] = "4";
  CHECK(machine.run(show, words).out == "30 2 4");
  CHECK(machine.run(show, {"mix", "a", "--gap-ms=40", "--jobs", "5"}).out == "40 2 5");
}

TEST_CASE("--config takes the place of the project's file") {
  const FreshFolder folder;
  folder.write("project/kinalign.toml", "[mix]\nrows = 4\n");
  const std::string other = folder.write("other.toml", "[mix]\nrows = 6\n");
  const Machine machine = machine_in(folder);
  CHECK(machine.run(show, {"mix", "a", "--jobs=1", "--config", other}).out == "50 6 1");
  const Outcome missing = machine.run(show, {"mix", "a", "--config=/no/such"});
  CHECK(missing.code == 3);
  CHECK(missing.err ==
        "kinalign mix: /no/such: expected a readable file, found No such file or directory\n");
  Machine named = machine;
  named.variables["KINALIGN_CONFIG"] = "/no/such";
  const Outcome by_variable = named.run(show, {"mix", "a"});
  CHECK(by_variable.code == 3);
  CHECK(by_variable.err.ends_with(
      "such file or directory\n  the variable KINALIGN_CONFIG names this file\n"));
}

TEST_CASE("a fault in a settings file is reported with its line") {
  const FreshFolder folder;
  const Machine machine = machine_in(folder);
  const std::string path = folder / "project/kinalign.toml";
  const auto message = [&](const std::string& text) {
    folder.write("project/kinalign.toml", text);
    const Outcome outcome = machine.run(show, {"mix", "a"});
    CHECK(outcome.code == 2);
    const auto end = outcome.err.find('\n');
    CHECK(outcome.err.substr(end) ==
          "\n  docs/commands.md describes a settings file, docs/formats/lab_toml.md describes a "
          "lab file\n");
    return outcome.err.substr(0, end);
  };
  CHECK(message("[mix]\nrwos = 2\n") ==
        "kinalign mix: " + path + ":2: expected a setting of mix (did you mean rows?), found rwos");
  CHECK(message("[mxi]\nrows = 2\n") ==
        "kinalign mix: " + path + ":2: expected a verb (did you mean mix?), found mxi");
  CHECK(message("rows = 2\n") ==
        "kinalign mix: " + path + ":1: expected a setting of all verbs, found rows");
  CHECK(message("[mix]\nrows = 99\n") ==
        "kinalign mix: " + path + ":2: expected a whole number from 1 to 10, found 99");
  CHECK(message("[mix]\nrows = [1, 2]\n") ==
        "kinalign mix: " + path + ":2: expected one value for rows, found 2");
  CHECK(message("[mix]\nrows = {a = 1}\n").find(":2: expected settings, ") != std::string::npos);
  CHECK(message("[mix]\n[devices.mocap]\nport = 1\n") ==
        "kinalign mix: " + path +
            ":2: expected settings, or a lab's device as [device.mocap], found [devices.mocap]");
  CHECK(message("[[device]]\nport = 1\n") ==
        "kinalign mix: " + path +
            ":1: expected settings, or a lab's device as [device.NAME], found [[device]]");
  CHECK(message("[devices]\nport = 1\n") ==
        "kinalign mix: " + path + ":2: expected a verb (did you mean device?), found devices");
  CHECK(message("[mix\n").find(":1: expected TOML, found ") != std::string::npos);
}

TEST_CASE("a fault in the environment is reported with the variable's name") {
  const Machine machine{.variables = {{"KINALIGN_ROWS", "many"}}};
  CHECK(machine.run(show, {"mix", "a"})
            .err.starts_with("kinalign mix: KINALIGN_ROWS: expected a whole number from 1 to 10"));
}

TEST_CASE("a help page begins with an example and lists flags, settings and standard values") {
  const Outcome outcome = Machine{}.run(nothing, {"mix", "--help"});
  CHECK(outcome.code == 0);
  CHECK(outcome.out.starts_with("  kinalign mix a.bvh\n"));
  CHECK(outcome.out.find("usage  kinalign mix FILE... [FLAGS]\n") != std::string::npos);
  CHECK(outcome.out.find("  --gap-ms NUMBER           longest gap, ms [50]\n") !=
        std::string::npos);
  CHECK(outcome.out.find("  -o, --out FILE ") != std::string::npos);
  CHECK(Machine{}.run(nothing, {"help", "mix"}).out == outcome.out);
}

TEST_CASE("the man page and the completions name every verb, flag and choice") {
  const std::vector<Verb> verbs{mix_verb(nothing)};
  CHECK(man_page(verbs).find(".B \\-\\-gap\\-ms NUMBER\n") != std::string::npos);
  const std::string bash = completion_script("bash", verbs);
  CHECK(bash.find("'mix --rotations') words='spline slerp' ;;") != std::string::npos);
  CHECK(bash.find("--interval-ms") != std::string::npos);
  CHECK(completion_script("zsh", verbs).find("--rotations[between samples]:value:(spline slerp)") !=
        std::string::npos);
  CHECK(completion_script("fish", verbs).find("-l rotations -x -a 'spline slerp'") !=
        std::string::npos);
}

TEST_CASE("completions list the choices of all positionals as words of their own") {
  const std::vector<Verb> verbs{
      make_verb<Pour>({.name = "pour", .summary = "", .text = "", .examples = {}, .common = {}},
                      describe_pour, [](Pour&, Call&) -> Result<int> { return 0; })};
  CHECK(completion_script("bash", verbs).find("words='jug cup glass' ;;") != std::string::npos);
  CHECK(completion_script("zsh", verbs).find("'*:word:(jug cup glass)'") != std::string::npos);
}

TEST_CASE("every verb has a summary and an example that begins with the program's name") {
  for (const Verb& verb : all_verbs()) {
    CAPTURE(verb.page.name);
    CHECK_FALSE(verb.page.summary.empty());
    REQUIRE_FALSE(verb.page.examples.empty());
    CHECK(verb.page.examples.front().command.starts_with("kinalign " + verb.page.name));
  }
}

TEST_CASE(
    "bash completes verbs, flags, choices and layouts of the program as built, files elsewhere") {
  const std::string program = KINALIGN_BINARY_DIR "/apps/kinalign/kinalign";
  const std::string script =
      "source <('" + program +
      "' completion bash)\n"
      "ask() { COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _kinalign; echo \"${COMPREPLY[*]}\"; "
      "}\n"
      "[ \"$(ask kinalign conf)\" = config ] && [ \"$(ask kinalign config --js)\" = --json ] &&\n"
      "[ \"$(ask kinalign config --color a)\" = 'auto always' ] &&\n"
      "[ \"$(ask kinalign completion z)\" = zsh ] &&\n"
      "[ -z \"$(ask kinalign align --kinect '')$(ask kinalign align -o '')$(ask kinalign info "
      "'')\" ] &&\n"
      "[ \"$(ask kinalign align --kinect-layout keraal_k)\" = keraal_kinect ]";
  const FreshFolder folder;
  const std::string file = folder.write("ask.sh", script);
  CHECK(std::system(("bash '" + file + "'").c_str()) == 0);
}
