// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/verbs/take_origin.h"

#include "apps/cli/json_text.h"
#include "apps/kinalign/text/describe_file.h"

#include "kinalign/documents/parameters_json.h"
#include "kinalign/formats/take/guarded.h"
#include "kinalign/formats/take/take_hdf5.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace kinalign {

namespace {

/// The software, the parameters and the hashes of the inputs of a take, as JSON. The function runs
/// in a child process, because HDF5 can crash on a damaged file.
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

}  // namespace

Result<Origin> origin_of(FileSystem& files, const std::string& path) {
  // If the child process crashes, the error from blame() names the take.
  const std::string text =
      KA_TRY(run_guarded(GuardLimits{}, blame(path), [&] { return origin_json(files, path); }));
  try {  // the child read a file that may be damaged, so its text may be wrong
    const auto json = nlohmann::json::parse(text);
    Origin origin;
    origin.software = json.at("software").get<std::string>();
    origin.parameters = KA_TRY(parse_parameters_json(json.at("parameters").get<std::string>()));
    for (const auto& file : json.at("files")) {
      // The file's size stays 0, because changed_inputs() compares only hashes.
      origin.files.push_back({file.at(0).get<std::string>(), file.at(1).get<std::string>(), 0});
    }
    return origin;
  } catch (const nlohmann::json::exception&) {
    return Failure(Error{path, 0, "a take that states how it was made", "no such statement"});
  }
}

std::vector<std::string> changed_inputs(const Origin& origin, const Recording& recording) {
  // A file that several streams read is listed once. The name must be equal, too, so two files that
  // were exchanged are found.
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

}  // namespace kinalign
