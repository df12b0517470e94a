// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/cli/json_text.h"
#include "apps/kinalign/text/summary.h"
#include "apps/kinalign/verbs.h"
#include "apps/kinalign/verbs/align_job.h"
#include "apps/kinalign/verbs/inputs.h"
#include "apps/kinalign/verbs/scratch.h"
#include "apps/kinalign/verbs/take_origin.h"

#include "kinalign/sources/open_recording.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

/// The options of `kinalign rebuild`: --inputs, and either -o or --verify.
struct Rebuild {
  std::vector<std::string> take;
  std::string inputs;
  bool verify = false;
};

/// The command line of `kinalign rebuild`.
Usage describe_rebuild(Rebuild& o) {
  Usage usage;
  usage.positionals = {{"TAKE", "a take that kinalign wrote", &o.take}};
  usage.flags = {{"inputs", "folder of the files that the take was made from", &o.inputs},
                 {"verify", "compare every byte with the take; write nothing", &o.verify}};
  usage.check = [&o](const Common& common, const Sources& /*given*/) -> Result<void> {
    if (o.inputs.empty()) {
      return Failure(Error{"--inputs", 0, "the folder of the take's inputs", "none"});
    }
    // Exactly one of -o and --verify must be given. The condition is true if both or neither were
    // given.
    if (o.verify != common.out.empty()) {
      return Failure(Error{"-o", 0, "either the new take's file name or --verify",
                           o.verify ? "both" : "neither"});
    }
    KA_TRY(check_take_name(common.out));
    return {};
  };
  return usage;
}

/// The result of --verify. At most one of `difference` and `failure` is set. If neither is set, the
/// new take has the same bytes as the old one.
struct Comparison {
  std::optional<std::uint64_t> difference;  // the position of the first byte that differs
  std::optional<Error> failure;             // the reason why the take can't be made again
  std::vector<std::string> changed;         // inputs whose bytes have changed since
  bool same() const { return !difference && !failure; }
};

/// Makes the take again in a temporary folder and compares the bytes. A failure caused by the
/// inputs is part of the result; a failure of this machine is an error.
Result<Comparison> compare(const std::string& take, const Result<Recording>& recording,
                           const Origin& origin, Call& call) {
  Comparison out;
  if (!recording) {
    // After Ctrl-C opening fails, too. The verb must then end and not report a difference.
    if (interrupted()) return Failure(recording.error());
    out.failure = recording.error();
    return out;
  }
  out.changed = changed_inputs(origin, *recording);
  // HDF5 must write a real file, because the bytes of the file are compared.
  const Scratch scratch = KA_TRY(Scratch::make());
  const std::string again = scratch.name() + "/take.h5";
  auto made = align_to_file(call, *recording, origin.parameters, {again, Overwrite::no});
  if (!made) {
    // If the disk of the temporary folder is full, that says nothing about the take, so it is an
    // error of the verb.
    const bool ours = interrupted() || made.error().file.starts_with(scratch.name());
    if (ours) return Failure(std::move(made).error());
    out.failure = std::move(made).error();
  } else {
    out.difference = KA_TRY(first_difference(call.surroundings.files, take, again));
  }
  return out;
}

/// The text about a changed input. harmless() removes control characters, since the name comes from
/// the take.
std::string changed_line(const std::string& name) {
  return harmless(name + " is not the file that the take was made from");
}

/// Prints the result of --verify and returns the exit code.
int say(const std::string& take, const Comparison& found, const Origin& origin, Call& call) {
  nlohmann::ordered_json json{{"take", take},
                              {"same", found.same()},
                              {"software", origin.software},
                              {"changed_inputs", found.changed}};
  std::string text = fmt::format("{}: all bytes are equal\n", take);
  // `difference` and `failure` are never both set: only a take that could be made again is
  // compared.
  if (found.difference) {
    text = fmt::format("{}: bytes differ from byte {} on\n", take, *found.difference);
    json["first_difference"] = *found.difference;
  } else if (found.failure) {
    text = fmt::format("{}: differs: the take can't be made again: {}\n", take,
                       to_string(*found.failure));
    json["failure"] = to_string(*found.failure);
  }
  for (const std::string& name : found.changed) text += "  " + changed_line(name) + "\n";
  // If all inputs are the same, either the take's file was edited or another version of the program
  // computes other values.
  if (found.difference && found.changed.empty()) {
    text += fmt::format(
        "  the inputs are the same; the take was changed, or this version differs from {}\n",
        origin.software);
  }
  call.console.print(harmless(text));
  call.console.print_json(json_text(json));
  return found.same() ? 0 : 1;
}

/// Makes the take again and writes it. A changed input is a warning.
Result<int> write_again(const Recording& recording, const Origin& origin, Call& call) {
  const std::string& out = call.common.out;
  const std::vector<std::string> changed = changed_inputs(origin, recording);
  // The user may have corrected an input on purpose, so the take is written in any case. The exit
  // code is then 1.
  for (const std::string& name : changed) {
    call.console.note("kinalign rebuild: warning: " + changed_line(name));
  }
  const AlignmentReport report =
      KA_TRY(align_to_file(call, recording, origin.parameters, {out, call.common.overwrite()}));
  call.console.wrote(out);
  call.console.print(summary(report, out, call.console));
  call.console.print_json(json_text(nlohmann::ordered_json{
      {"written", true}, {"frames", report.frames}, {"changed_inputs", changed}}));
  return changed.empty() ? code_of(report.findings) : 1;
}

/// Reads how the take was made, checks the inputs, and then compares or writes. No file is opened
/// for writing before all inputs were found.
Result<int> run(Rebuild& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  const std::string& take = o.take.front();
  const Origin origin = KA_TRY(origin_of(files, take));
  const std::string base = o.inputs.ends_with('/') ? o.inputs : o.inputs + "/";
  const std::vector<std::string> inputs = files_named(origin.parameters, base);
  KA_TRY(keep_inputs(call.common.out, inputs));
  call.console.if_it_fails(
      [base, take, count = inputs.size()](const Error& error) -> std::vector<std::string> {
        if (!error.file.starts_with(base)) return {};
        return {
            fmt::format("--inputs must be one folder with all {} files of the take, under the "
                        "names that kinalign info {} shows: copy or link them there",
                        count, take)};
      });
  // Each file is opened only to find out early whether it exists. A missing input is an error and
  // not a difference, because it says nothing about the take.
  for (const std::string& input : inputs) KA_TRY(InputFile::open(files, input));
  Result<Recording> recording =
      open_recording(files, origin.parameters, base, {call.console.progress(), call.jobs});
  if (o.verify) return say(take, KA_TRY(compare(take, recording, origin, call)), origin, call);
  return write_again(KA_TRY(std::move(recording)), origin, call);
}

}  // namespace

/// The verb `kinalign rebuild`.
Verb rebuild_verb() {
  return make_verb<Rebuild>(
      {.name = "rebuild",
       .summary = "make a take again from its inputs, or compare every byte",
       .text = "A take contains every parameter of its alignment and the SHA-256 of every input. "
               "Exit code 1 if an input is not the file that the take was made from, or if there "
               "were warnings.",
       .examples = {{"kinalign rebuild demo/take.h5 --inputs demo --verify",
                     "exit code 0: the same bytes; 1: not"},
                    {"kinalign rebuild demo/take.h5 --inputs demo -o demo/again.h5",
                     "writes it again"}},
       .common = {"out", "force", "json", "jobs"}},
      describe_rebuild, run);
}

}  // namespace kinalign
