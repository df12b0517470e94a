// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/align_job.h"
#include "apps/kinalign/console.h"
#include "apps/kinalign/inputs.h"
#include "apps/kinalign/json_text.h"
#include "apps/kinalign/summary.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/io/open_recording.h"
#include "kinalign/io/parameters_json.h"
#include "kinalign/io/take_hdf5.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

namespace kinalign {

namespace {

struct Rebuild {
  std::vector<std::string> take;
  std::string inputs;
  bool verify = false;
};

Usage describe_rebuild(Rebuild& o) {
  Usage usage;
  usage.positionals = {{"TAKE", "a take that kinalign wrote", &o.take}};
  usage.flags = {{"inputs", "folder of the files that the take was made from", &o.inputs},
                 {"verify", "compare every byte with the take; write nothing", &o.verify}};
  usage.check = [&o](const Common& common, const Sources& /*given*/) -> Result<void> {
    if (o.inputs.empty()) {
      return Failure(Error{"--inputs", 0, "the folder of the take's inputs", "none"});
    }
    if (o.verify != common.out.empty()) {
      return Failure(Error{"-o", 0, "either the new take's file name or --verify",
                           o.verify ? "both" : "neither"});
    }
    return {};
  };
  return usage;
}

/// What a take says of its making; read in a child process.
struct Origin {
  std::string software;
  Manifest parameters;
  std::vector<InputFacts> files;
};

Result<std::string> origin_json(FileSystem& files, const std::string& path) {
  const TakeReader reader = KA_TRY(TakeReader::open(files, path));
  nlohmann::json out{{"software", reader.software()},
                     {"parameters", parameters_json(reader.header().parameters)},
                     {"files", nlohmann::json::array()}};
  for (const TakeGroup& group : reader.header().groups) {
    for (const InputFacts& file : group.files) out["files"].push_back({file.name, file.sha256});
  }
  return json_text(out);
}

Result<Origin> origin_of(FileSystem& files, const std::string& path) {
  const auto json = nlohmann::json::parse(
      KA_TRY(run_guarded(GuardLimits{}, blame(path), [&] { return origin_json(files, path); })));
  Origin origin;
  origin.software = json["software"].get<std::string>();
  origin.parameters = KA_TRY(parse_parameters_json(json["parameters"].get<std::string>()));
  for (const auto& file : json["files"]) {
    origin.files.push_back({file[0].get<std::string>(), file[1].get<std::string>(), 0});
  }
  return origin;
}

/// Inputs whose bytes are not those of the take's making.
std::vector<std::string> changed_inputs(const Origin& origin, const Recording& recording) {
  std::vector<std::string> changed;
  for (const RecordedStream& stream : recording.streams) {
    for (const InputFacts& file : stream.files) {
      const bool same = std::any_of(
          origin.files.begin(), origin.files.end(),
          [&file](const InputFacts& f) { return f.name == file.name && f.sha256 == file.sha256; });
      const bool named = std::find(changed.begin(), changed.end(), file.name) != changed.end();
      if (!same && !named) changed.push_back(file.name);
    }
  }
  return changed;
}

/// Byte of the first difference; nothing where two files are the same.
Result<std::optional<std::uint64_t>> first_difference(FileSystem& files, const std::string& a,
                                                      const std::string& b) {
  InputFile one = KA_TRY(InputFile::open(files, a)), other = KA_TRY(InputFile::open(files, b));
  for (std::uint64_t at = 0;;) {
    const std::string_view p = KA_TRY(one.next()), q = KA_TRY(other.next());
    const std::size_t both = std::min(p.size(), q.size());
    const auto differ =
        std::mismatch(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(both), q.begin());
    const auto same = static_cast<std::uint64_t>(differ.first - p.begin());
    if (same < both || p.size() != q.size()) return std::optional(at + same);
    if (p.empty()) return std::optional<std::uint64_t>{};
    at += both;
  }
}

/// A folder that goes with everything in it.
class Scratch {
 public:
  static Result<Scratch> make() {
    std::string name = (std::filesystem::temp_directory_path() / "kinalign-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      return Failure(Error{name, 0, "room for a temporary folder", "none"});
    }
    return Scratch(std::move(name));
  }
  Scratch(Scratch&& other) noexcept : name_(std::exchange(other.name_, {})) {}
  Scratch& operator=(Scratch&&) = delete;
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() {
    std::error_code ignored;
    if (!name_.empty()) std::filesystem::remove_all(name_, ignored);
  }
  const std::string& name() const { return name_; }

 private:
  explicit Scratch(std::string name) : name_(std::move(name)) {}
  std::string name_;
};

Result<int> verify(const std::string& take, const Recording& recording, const Origin& origin,
                   Call& call) {
  FileSystem& files = call.surroundings.files;
  const Scratch scratch = KA_TRY(Scratch::make());
  const std::string again = scratch.name() + "/take.h5";
  KA_TRY(align_to_file(call, recording, origin.parameters, {again, Overwrite::no}));
  const auto difference = KA_TRY(first_difference(files, take, again));
  const auto changed = changed_inputs(origin, recording);
  nlohmann::ordered_json json{{"take", take},
                              {"same", !difference},
                              {"software", origin.software},
                              {"changed_inputs", changed}};
  std::string text = fmt::format("{}: every byte agrees\n", take);
  if (difference) {
    text = fmt::format("{}: differs from byte {} on\n", take, *difference);
    json["first_difference"] = *difference;
  }
  for (const std::string& name : changed) {
    text += fmt::format("  {} is not the file that the take was made from\n", name);
  }
  if (difference && changed.empty()) {
    text += fmt::format(
        "  the inputs are the same; the take was changed, or another version than {} "
        "remade it\n",
        origin.software);
  }
  call.console.print(harmless(text));
  call.console.print_json(json_text(json));
  return difference ? 1 : 0;
}

Result<int> run(Rebuild& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  const std::string& take = o.take.front();
  const Origin origin = KA_TRY(origin_of(files, take));
  const std::string base = o.inputs.ends_with('/') ? o.inputs : o.inputs + "/";
  const Recording recording =
      KA_TRY(open_recording(files, origin.parameters, base, call.console.progress(), call.jobs));
  if (o.verify) return verify(take, recording, origin, call);
  KA_TRY(keep_inputs(call.common.out, files_named(origin.parameters, base)));
  const AlignmentReport report = KA_TRY(align_to_file(call, recording, origin.parameters,
                                                      {call.common.out, call.common.overwrite()}));
  call.console.print(summary(report, call.common.out, call.console));
  call.console.print_json(fmt::format("{{\"written\": true, \"frames\": {}}}", report.frames));
  return 0;
}

}  // namespace

Verb rebuild_verb() {
  return make_verb<Rebuild>(
      {.name = "rebuild",
       .summary = "make a take again from its inputs, compare every byte",
       .text = "A take holds every parameter that made it and the SHA-256 of every input.",
       .examples = {{"kinalign rebuild take.h5 --inputs recordings --verify",
                     "exit code 0: the same bytes; 1: not"},
                    {"kinalign rebuild take.h5 --inputs recordings -o again.h5",
                     "writes it again"}},
       .common = {"out", "force", "json", "jobs"}},
      describe_rebuild, run);
}

}  // namespace kinalign
