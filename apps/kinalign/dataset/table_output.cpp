// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/dataset/table_output.h"

namespace kinalign {

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
