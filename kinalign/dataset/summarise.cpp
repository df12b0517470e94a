// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/summarise.h"

#include "kinalign/dataset/contents.h"
#include "kinalign/documents/report_json.h"
#include "kinalign/formats/take/guarded.h"
#include "kinalign/formats/take/take_hdf5.h"
#include "kinalign/sources/input_facts.h"

#include <nlohmann/json.hpp>

#include <string_view>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// The error as JSON, in which the child process sends it.
Json error_json(const Error& error) {
  return {{"file", error.file},
          {"line", error.line},
          {"expected", error.expected},
          {"found", error.found}};
}

Error error_from(const Json& json) {
  return {json.at("file").get<std::string>(), json.at("line").get<std::int64_t>(),
          json.at("expected").get<std::string>(), json.at("found").get<std::string>()};
}

/// The line for one take: the text that `ask` returned, or its error.
std::string line_of(const Result<std::string>& answer) {
  const Json line =
      answer ? Json{{"answer", *answer}} : Json{{"error", error_json(answer.error())}};
  return line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// The text or the error in a line of line_of().
Result<std::string> from_line(std::string_view line) {
  const Json json = Json::parse(line);
  if (json.contains("error")) return Failure(error_from(json["error"]));
  return json.at("answer").get<std::string>();
}

/// The question that summarise_takes() asks about each take.
Result<std::string> summary_text(TakeReader& reader) {
  return summary_json(KA_TRY(summary_of(reader)));
}

/// The error of a take that makes the child process crash.
Error blame(const std::string& path) { return {path, 0, "a take that HDF5 can read", ""}; }

}  // namespace

std::vector<Result<std::string>> ask_takes(
    FileSystem& files, const std::string& folder, const std::vector<TakeName>& names,
    const std::function<Result<std::string>(TakeReader&)>& ask) {
  std::vector<Result<std::string>> out;
  const auto answer = [&](const TakeName& name) -> Result<std::string> {
    TakeReader reader = KA_TRY(TakeReader::open(files, path_of(folder, name, TakeFile::take)));
    return ask(reader);
  };
  // Each round starts one child process, which answers for all remaining takes. If the process
  // crashes, the take that it was reading gets an error, and the next round begins after that take.
  while (out.size() < names.size()) {
    const std::size_t first = out.size();
    std::string text;  // the line that has not ended yet
    // The child process is a copy of this process, so it needs no arguments.
    const auto work = [&](const GuardSend& send) -> Result<void> {
      for (std::size_t i = first; i < names.size(); ++i) KA_TRY(send(line_of(answer(names[i]))));
      return {};
    };
    const auto receive = [&](std::string_view bytes) -> Result<void> {
      // A piece may end within a line, so only complete lines are parsed.
      text += bytes;
      for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
        out.push_back(from_line(std::string_view(text).substr(0, end)));
        text.erase(0, end + 1);
      }
      return {};
    };
    auto done = run_guarded(GuardLimits{}, blame(path_of(folder, names[first], TakeFile::take)),
                            work, receive);
    // If the child process fails after its last answer, all takes have their answers.
    if (done || out.size() == names.size()) continue;
    done.error().file = path_of(folder, names[out.size()], TakeFile::take);
    out.push_back(Failure(std::move(done).error()));
  }
  return out;
}

Result<TakeSummary> summary_of(TakeReader& reader) {
  TakeSummary made = KA_TRY(summary_of(reader.header(), KA_TRY(reader.report_json())));
  // This is the program that made the take, possibly an older version.
  made.software = reader.software();
  return made;
}

Result<TakeSummary> keep_summary(FileSystem& files, const std::string& folder, const TakeName& name,
                                 TakeSummary summary) {
  // The hash is computed from the file on the disk, not from the bytes that were written.
  const InputFacts facts =
      KA_TRY(facts_of(files, path_of(folder, name, TakeFile::take), "hashing", {}));
  summary.sha256 = facts.sha256;
  summary.bytes = facts.bytes;
  KA_TRY(write_whole(files, path_of(folder, name, TakeFile::summary), summary_json(summary),
                     Overwrite::yes));
  return summary;
}

std::vector<Result<TakeSummary>> summarise_takes(FileSystem& files, const std::string& folder,
                                                 const std::vector<TakeName>& names) {
  std::vector<Result<TakeSummary>> out;
  const auto texts = ask_takes(files, folder, names, summary_text);
  for (std::size_t i = 0; i < names.size(); ++i) {
    // A hostile file may have taken over the child process, so its text is parsed like any foreign
    // text.
    out.push_back(texts[i]
                      ? parse_summary_json(*texts[i], path_of(folder, names[i], TakeFile::take))
                      : Failure(texts[i].error()));
  }
  return out;
}

Result<Findings> check_rows(FileSystem& files, const std::string& folder, const TakeName& name,
                            double rate_hz) {
  const std::string path = path_of(folder, name, TakeFile::take);
  const std::string text =
      KA_TRY(run_guarded(GuardLimits{}, blame(path), [&]() -> Result<std::string> {
        TakeReader reader = KA_TRY(TakeReader::open(files, path));
        ContentCheck check(reader.header(), rate_hz);
        TakeSlab slab;
        while (KA_TRY(reader.next(slab))) check.add(slab);
        return findings_json(check.findings(path_of(name, TakeFile::take)));
      }));
  return parse_findings_json(text);
}

}  // namespace kinalign
