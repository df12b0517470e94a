// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/dataset/common.h"

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

Field format_field(std::string& format) {
  return {"format", "how it is printed", &format, 0.0, 0.0, {"text", "markdown", "latex", "csv"}};
}

void print_table(const Table& table, const std::string& format, const std::string& name,
                 Call& call) {
  if (call.console.prints_json()) {
    call.console.print_json("{\"" + name + "\": " + written(table, TableFormat::json) + "}");
    return;
  }
  call.console.put(harmless(written(table, table_format(format).value_or(TableFormat::text))));
}

}  // namespace kinalign
