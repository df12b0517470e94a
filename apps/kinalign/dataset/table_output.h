// SPDX-License-Identifier: Apache-2.0
// Prints tables on stdout in the format of --format or --json.
#pragma once

#include "apps/cli/console.h"
#include "apps/cli/verb.h"

#include "kinalign/view/table.h"

#include <initializer_list>
#include <string>
#include <vector>

namespace kinalign {

/// The flag --format. With --json tables are JSON whatever the flag says.
Field format_field(std::string& format);
/// A table, and its name in JSON.
/// print_tables() joins several of them. In text the name is not shown.
struct NamedTable {
  std::string name;
  Table table;
};
/// Writes a table as files in these formats; `path` has no ending.
Result<void> write_table(const Table& table, const std::string& path,
                         std::initializer_list<TableFormat> formats, Call& call);
/// Prints tables one below the other in that format, or as members of one JSON object.
/// Results go to standard output also with --quiet, because the table is what the verb is called
/// for.
void print_tables(const std::vector<NamedTable>& tables, const std::string& format, Call& call);

}  // namespace kinalign
