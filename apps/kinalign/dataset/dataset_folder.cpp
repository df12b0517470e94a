// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/dataset/dataset_folder.h"

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

}  // namespace kinalign
