// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/dataset/table_output.h"

#include <algorithm>
#include <utility>

namespace kinalign {

Field format_field(std::string& format) {
  return choice_flag("format", "format of the table", &format,
                     {"text", "markdown", "latex", "csv"});
}

Result<void> write_table(const Table& table, const std::string& path,
                         std::initializer_list<TableFormat> formats, Call& call) {
  for (const auto& [format, ending] :
       {std::pair(TableFormat::markdown, ".md"), std::pair(TableFormat::latex, ".tex"),
        std::pair(TableFormat::csv, ".csv"), std::pair(TableFormat::json, ".json")}) {
    if (std::find(formats.begin(), formats.end(), format) == formats.end()) continue;
    KA_TRY(write_whole(call.surroundings.files, path + ending, written(table, format),
                       Overwrite::yes));
  }
  return {};
}

void print_tables(const std::vector<NamedTable>& tables, const std::string& format, Call& call) {
  // With --json the tables become one object; each table is a member under its name.
  if (call.console.prints_json()) {
    std::string object;
    for (const NamedTable& one : tables) {
      object += (object.empty() ? "{\"" : ", \"") + one.name +
                "\": " + written(one.table, TableFormat::json);
    }
    call.console.print_json(object + "}");
    return;
  }
  std::string text;
  for (const NamedTable& one : tables) {
    text += (text.empty() ? "" : "\n") +
            // The parser refuses unknown formats, so "text" is never used in their place.
            written(one.table, table_format(format).value_or(TableFormat::text));
  }
  // harmless() removes control characters, since names in tables come from files. put() prints even
  // with --quiet.
  call.console.put(harmless(text));
}

}  // namespace kinalign
