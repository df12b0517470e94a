// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/dataset/dataset_folder.h"

#include "apps/kinalign/text/counts_text.h"

#include "kinalign/dataset/scan.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace kinalign {

Positional folder_word(std::vector<std::string>& folder) {
  return {"FOLDER", "the data set", &folder};
}

std::string folder_of(const std::vector<std::string>& words) {
  std::string folder = words.front();
  // The root folder "/" keeps its '/'.
  while (folder.size() > 1 && folder.ends_with('/')) folder.pop_back();
  return folder.empty() ? "." : folder;
}

Field where_field(std::string& where) {
  return text_flag("where", "use only takes that meet this condition (see `dataset query`)", &where,
                   "SQL");
}

Field split_field(std::string& split) {
  return text_flag("split", "file with parts, written by `dataset split`", &split, "FILE");
}

Result<DatasetIndex> open_index(const std::string& folder, Call& call) {
  DatasetIndex index = KA_TRY(DatasetIndex::open(call.surroundings.files, folder));
  // A take whose summary can't be read is missing in all tables. The user must therefore always see
  // this finding.
  for (const Finding& finding : index.findings()) {
    call.console.note(harmless(std::string(to_string(finding.severity)) + ": " +
                               to_string(finding.what) + ": " + finding.meaning));
  }
  return index;
}

Result<void> print_not_built(const DatasetIndex& index, const std::string& folder, Call& call) {
  const std::uint64_t not_built = KA_TRY(index.not_built());
  if (not_built == 0) return {};
  call.console.print(harmless(
      fmt::format("note   {} not built and therefore not counted: kinalign dataset build {}\n",
                  counted(not_built, "take"), folder)));
  return {};
}

Result<std::vector<SplitTake>> built_takes(FileSystem& files, const std::string& folder,
                                           const DatasetIndex& index, const std::string& where) {
  // The brackets keep an "or" in the user's condition apart from the rest of the query.
  const std::string condition = where.empty() ? "" : " where (" + where + ")";
  const Table names = KA_TRY(index.select("select name from takes" + condition + " order by name"));
  std::vector<SplitTake> takes;
  for (const auto& row : names.rows) {
    // A row is skipped if its value is not the name of a take: a view of SQL may contain values of
    // any type.
    const auto* text = std::get_if<std::string>(&row.front());
    const auto name = text == nullptr ? std::nullopt : parse_take_name(*text);
    // The index has only a part of each summary, and splits and exports need all of it.
    if (name) takes.push_back({*name, KA_TRY(read_summary(files, folder, *name))});
  }
  return takes;
}

std::string first_lines(const std::vector<std::string>& lines, std::size_t most,
                        const std::string& last) {
  const std::size_t shown = std::min(lines.size(), most);
  std::string out;
  for (std::size_t i = 0; i < shown; ++i) out += lines[i];
  return shown == lines.size() ? out : out + fmt::format(fmt::runtime(last), lines.size() - shown);
}

bool print_findings(const Findings& findings, Call& call) {
  // Thousands of findings would fill the terminal, so only the first ones are printed. The exit
  // code counts all of them.
  constexpr std::size_t shown_findings = 8;
  std::vector<std::string> lines;
  for (const Finding& one : findings) {
    lines.push_back(fmt::format("{}  {}\n", to_string(one.severity), to_string(one.what)));
  }
  call.console.print(
      harmless(first_lines(lines, shown_findings, "... and {} more (--json has them)\n")));
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& one) { return one.severity == Severity::error; });
}

// Each line begins with two spaces, because it stands below a line of the verb.
std::string splits_text(const std::vector<SplitFile>& splits) {
  std::string out;
  for (const SplitFile& one : splits) {
    out += fmt::format("  {} names {} of these takes: make it again with kinalign dataset split\n",
                       one.path, one.takes);
  }
  return out;
}

nlohmann::ordered_json splits_json(const std::vector<SplitFile>& splits) {
  auto out = nlohmann::ordered_json::array();
  for (const SplitFile& one : splits) out.push_back({{"file", one.path}, {"takes", one.takes}});
  return out;
}

}  // namespace kinalign
