// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/console.h"
#include "apps/kinalign/describe_file.h"
#include "apps/kinalign/inputs.h"
#include "apps/kinalign/json_text.h"
#include "apps/kinalign/summary.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/io/recover_recording.h"
#include "kinalign/io/report_json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

struct Recover {
  std::vector<std::string> files;
};

Usage describe_recover(Recover& o) {
  Usage usage;
  usage.positionals = {
      {"FILE", "a recording's file, or all of them in any order", &o.files, 1, SIZE_MAX}};
  usage.check = [](const Common& common, const Sources&) -> Result<void> {
    if (common.out.empty()) return Failure(Error{"--out", 0, "a new file's name", "none"});
    return {};
  };
  return usage;
}

Result<int> run(Recover& o, Call& call) {
  call.console.if_it_fails([](const Error&) {
    return std::vector<std::string>{"nothing was written; the old files are as they were"};
  });
  const std::string& out = call.common.out;
  KA_TRY(keep_inputs(out, o.files));
  const Recovered done = KA_TRY(recover_recording(
      call.surroundings.files, o.files, out, call.common.overwrite(), call.console.progress()));
  call.console.wrote(out);
  std::string text = fmt::format("{}: {} messages in {} channels, read again and whole\n", out,
                                 grouped(done.messages), done.proof.channels.size());
  if (done.unchecked > 0) {
    text +=
        fmt::format("  {} of them no checksum covers (a torn end, or messages outside of chunks)\n",
                    grouped(done.unchecked));
  }
  if (done.twice > 0) text += fmt::format("  {} stood in two files\n", grouped(done.twice));
  if (done.nameless > 0) {
    text += fmt::format("  {} left out: what their channel is was lost\n", grouped(done.nameless));
  }
  call.console.print(harmless(text) + finding_lines(done.findings, call.console));
  call.console.print_json(json_text(nlohmann::ordered_json{
      {"file", out},
      {"messages", done.messages},
      {"unchecked", done.unchecked},
      {"twice", done.twice},
      {"nameless", done.nameless},
      {"findings", nlohmann::ordered_json::parse(findings_json(done.findings))}}));
  return code_of(done.findings);
}

}  // namespace

Verb recover_verb() {
  return make_verb<Recover>(
      {.name = "recover",
       .summary = "a torn recording, or several parts of one, into a whole file",
       .text = "Copies every message that can be read, once, gives the new file its index, and "
               "reads it again before it gets its name: what stands there must be what was copied. "
               "The old files stay as they are. Exit code "
               "1 where something was damaged or could not be read; a file that only lacks its "
               "index and end is made whole with 0.",
       .examples = {{"kinalign recover takes/03_S1A02_01.mcap -o whole.mcap", "after a power cut"},
                    {"kinalign recover a.mcap a.part2.mcap -o whole.mcap",
                     "after a disk that failed: of what stands in both the later is taken"}},
       .common = {"out", "force", "json"}},
      describe_recover, run);
}

}  // namespace kinalign
