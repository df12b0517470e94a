// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/dataset/table_output.h"

namespace kinalign {

Field format_field(std::string& format) {
  return {"format", "format of the table", &format, 0.0, 0.0, {"text", "markdown", "latex", "csv"}};
}

void print_tables(const std::vector<NamedTable>& tables, const std::string& format, Call& call) {
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
            written(one.table, table_format(format).value_or(TableFormat::text));
  }
  call.console.put(harmless(text));
}

void print_table(const Table& table, const std::string& format, const std::string& name,
                 Call& call) {
  print_tables({{name, table}}, format, call);
}

}  // namespace kinalign
