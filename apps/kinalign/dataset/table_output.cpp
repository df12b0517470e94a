// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/dataset/table_output.h"

namespace kinalign {

Field format_field(std::string& format) {
  return choice_flag("format", "format of the table", &format,
                     {"text", "markdown", "latex", "csv"});
}

void print_tables(const std::vector<NamedTable>& tables, const std::string& format, Call& call) {
  // With --json each table is a member of one object, under its own name.
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
            // An unknown format can't reach this place, since the parser knows the choices. Text is
            // the fallback.
            written(one.table, table_format(format).value_or(TableFormat::text));
  }
  // Names in tables come from files and are made harmless. put() prints them also with --quiet.
  call.console.put(harmless(text));
}

void print_table(const Table& table, const std::string& format, const std::string& name,
                 Call& call) {
  print_tables({{name, table}}, format, call);
}

}  // namespace kinalign
