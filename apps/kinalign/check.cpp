// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/console.h"
#include "apps/kinalign/describe_file.h"
#include "apps/kinalign/inputs.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/align/judge.h"
#include "kinalign/io/report_json.h"
#include "kinalign/io/take_hdf5.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

struct Check {
  std::vector<std::string> files;
  StreamFlags stream;
};

Usage describe_check(Check& o) {
  Usage usage;
  usage.positionals = {{"FILE", "takes, recording.toml or streams' files", &o.files, 1, SIZE_MAX}};
  usage.flags = o.stream.fields();
  return usage;
}

/// Reads every row of a take, in the child.
Result<std::string> read_through(FileSystem& files, const std::string& path) {
  TakeReader reader = KA_TRY(TakeReader::open(files, path));
  TakeSlab slab;
  std::uint64_t rows = 0;
  while (KA_TRY(reader.next(slab))) rows += slab.stamps.size();
  if (rows != reader.header().frames) {
    return Failure(
        Error{path, 0, fmt::format("{} rows", reader.header().frames), std::to_string(rows)});
  }
  return std::string();
}

template <class Frames>
Result<void> read_all(const Passes<Frames>& passes) {
  const Pass<Frames> pass = KA_TRY(passes());
  Frames block;
  while (KA_TRY(pass(block))) {
  }
  return {};
}

/// Every value of a stream; the survey of a BVH reads none.
Result<void> read_through(const RecordedStream& stream) {
  return std::visit([](const auto& input) { return read_all(input.passes); }, stream.data);
}

Result<Findings> check_file(const Check& o, const std::string& path, Call& call) {
  FileSystem& files = call.surroundings.files;
  if (KA_TRY(is_take(files, path))) {
    KA_TRY(run_guarded(GuardLimits{}, blame(path), [&] { return read_through(files, path); }));
    return Findings{};
  }
  const Recording recording = KA_TRY(open_input(files, path, o.stream, call.console.progress()));
  Findings findings;
  for (const RecordedStream& stream : recording.streams) {
    KA_TRY(read_through(stream));
    const Findings stamps = judge_stamps(stream);
    findings.insert(findings.end(), stream.findings.begin(), stream.findings.end());
    findings.insert(findings.end(), stamps.begin(), stamps.end());
  }
  return findings;
}

Result<int> run(Check& o, Call& call) {
  Findings all;
  for (const std::string& path : o.files) {
    auto found = check_file(o, path, call);
    if (found) {
      all.insert(all.end(), found->begin(), found->end());
    } else if (o.files.size() == 1) {
      return Failure(std::move(found).error());
    } else {  // one file that can't be read must not hide what is wrong with the others
      all.push_back({Severity::error, std::move(found).error(), "the file can't be used", ""});
    }
  }
  call.console.print(harmless(finding_lines(all)));
  if (all.empty()) {
    call.console.print(fmt::format("{} file{} read, nothing found\n", o.files.size(),
                                   o.files.size() == 1 ? "" : "s"));
  }
  call.console.print_json("{\"findings\": " + findings_json(all) + "}");
  return all.empty() ? 0 : 1;
}

}  // namespace

Verb check_verb() {
  return make_verb<Check>(
      {.name = "check",
       .summary = "what is wrong with a file, and what it means",
       .text =
           "Reads every value. Exit code 1 where something was found, 3 where the file can't be "
           "used.",
       .examples = {{"kinalign check walk.bvh", "frames, unit, stamps"},
                    {"kinalign check recordings/*.bvh --json", "many files, for programs"}},
       .common = {"json"}},
      describe_check, run);
}

}  // namespace kinalign
