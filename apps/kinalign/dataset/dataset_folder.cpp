// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/dataset/dataset_folder.h"

#include "kinalign/dataset/scan.h"

namespace kinalign {

Positional folder_word(std::vector<std::string>& folder) {
  return {"FOLDER", "the data set", &folder};
}

std::string folder_of(const std::vector<std::string>& words) {
  std::string folder = words.front();
  while (folder.size() > 1 && folder.ends_with('/')) folder.pop_back();
  return folder.empty() ? "." : folder;
}

Result<DatasetIndex> open_index(const std::string& folder, Call& call) {
  DatasetIndex index = KA_TRY(DatasetIndex::open(call.surroundings.files, folder));
  for (const Finding& finding : index.findings()) {
    call.console.note(harmless(std::string(to_string(finding.severity)) + ": " +
                               to_string(finding.what) + ": " + finding.meaning));
  }
  return index;
}

Result<std::vector<SplitTake>> built_takes(FileSystem& files, const std::string& folder,
                                           const DatasetIndex& index, const std::string& where) {
  const std::string condition = where.empty() ? "" : " where (" + where + ")";
  const Table names = KA_TRY(index.select("select name from takes" + condition + " order by name"));
  std::vector<SplitTake> takes;
  for (const auto& row : names.rows) {
    const auto* text = std::get_if<std::string>(&row.front());
    const auto name = text == nullptr ? std::nullopt : parse_take_name(*text);
    if (name) takes.push_back({*name, KA_TRY(read_summary(files, folder, *name))});
  }
  return takes;
}

}  // namespace kinalign
