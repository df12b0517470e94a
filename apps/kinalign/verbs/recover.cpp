// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/recover.h"

#include "apps/cli/console.h"
#include "apps/cli/json_text.h"
#include "apps/kinalign/text/describe_file.h"
#include "apps/kinalign/text/summary.h"
#include "apps/kinalign/verbs.h"
#include "apps/kinalign/verbs/inputs.h"

#include "kinalign/documents/report_json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace kinalign {

namespace {

struct Recover {
  std::vector<std::string> files;
};

/// The command line of `kinalign recover`.
Usage describe_recover(Recover& o) {
  Usage usage;
  usage.positionals = {
      {"FILE",
       "a recording's file, read with all other parts in its folder; or several, in any order",
       &o.files, 1, SIZE_MAX}};
  // The user must name the new file, because the old files lie in the same folder and must not be
  // replaced.
  usage.check = [](const Common& common, const Sources&) -> Result<void> {
    if (common.out.empty()) return Failure(Error{"--out", 0, "a new file's name", "none"});
    return {};
  };
  return usage;
}

/// The first lines of the text: how many messages are in the new file, and how many of the old
/// files' messages are missing. The true number may be higher than `missing`, because only counted
/// or numbered messages can be missed.
std::string head_line(const std::string& out, const Recovered& done) {
  const std::string of =
      done.missing > 0 ? " of at least " + grouped(done.messages + done.missing) : "";
  std::string text = fmt::format("{}: {}{} messages in {} channels, read back and verified\n", out,
                                 grouped(done.messages), of, done.channels);
  if (done.missing > 0) {
    text += fmt::format("  {} are lost, by the recording's own numbers and counts\n",
                        grouped(done.missing));
  }
  if (done.skipped > 0) {
    text += fmt::format("  damage: {} bytes could not be read\n", grouped(done.skipped));
  }
  return text;
}

/// Recovers a recording and prints the counts. The exit code is 1 if messages are missing or
/// damaged.
Result<int> run(Recover& o, Call& call) {
  call.console.advise("nothing was written; the old files are unchanged");
  const std::string& out = call.common.out;
  // recover_recording() also refuses to overwrite the old files. This check gives the message that
  // other verbs give.
  KA_TRY(keep_inputs(out, o.files));
  const Recovered done = KA_TRY(recover_recording(
      call.surroundings.files, o.files, out, call.common.overwrite(), call.console.progress()));
  call.console.wrote(out);
  std::string text = head_line(out, done);
  // Each of the next three lines is printed only if its count is not 0. If a recording lacked only
  // its index, there is one line in all.
  if (done.unchecked > 0) {
    text +=
        fmt::format("  {} of them have no checksum (a truncated end, or a writer that made none)\n",
                    grouped(done.unchecked));
  }
  if (done.twice > 0)
    text += fmt::format("  {} further copies of messages were left out\n", grouped(done.twice));
  if (done.nameless > 0) {
    text += fmt::format("  {} left out: the definition of their channel is lost\n",
                        grouped(done.nameless));
  }
  call.console.print(harmless(text) + finding_lines(done.findings, call.console));
  call.console.print_json(json_text(nlohmann::ordered_json{
      {"file", out},
      {"messages", done.messages},
      {"unchecked", done.unchecked},
      {"twice", done.twice},
      {"nameless", done.nameless},
      {"missing", done.missing},
      {"skipped_bytes", done.skipped},
      {"findings", nlohmann::ordered_json::parse(findings_json(done.findings))}}));
  // Messages that are missing or have no name make the exit code 1 even without a finding.
  return std::max(code_of(done.findings), done.missing + done.nameless > 0 ? 1 : 0);
}

}  // namespace

/// The verb `kinalign recover`.
Verb recover_verb() {
  return make_verb<Recover>(
      {.name = "recover",
       .summary = "make a complete file from a truncated recording or its parts",
       .text =
           "Copies each readable message once and writes the index. The new file is read back and "
           "compared with what was copied before it gets its name. "
           "The old files are not changed. Exit code "
           "1 if data was damaged, unreadable or missing; 0 if only the index and the end of a "
           "file were missing.",
       .examples = {{"kinalign recover takes/03_S1A02_01.mcap -o whole.mcap", "after a power cut"},
                    {"kinalign recover a.mcap a.part2.mcap -o whole.mcap",
                     "after a disk failed: a message in both files is copied once"}},
       .common = {"out", "force", "json"}},
      describe_recover, run);
}

}  // namespace kinalign
