// SPDX-License-Identifier: Apache-2.0
// Prints tables on stdout, in the format of --format or as JSON with --json.
#pragma once

#include "apps/cli/console.h"
#include "apps/cli/verb.h"

#include "kinalign/view/table.h"

#include <initializer_list>
#include <string>
#include <vector>

namespace kinalign {

/// The flag --format. If --json is given, tables are JSON whatever --format says.
Field format_field(std::string& format);
/// A table and its name. The name appears in JSON only.
struct NamedTable {
  std::string name;
  Table table;
};
/// Writes a table into one file for each format. `path` is the file's name without its ending.
Result<void> write_table(const Table& table, const std::string& path,
                         std::initializer_list<TableFormat> formats, Call& call);
/// Prints tables one below the other in the given format, or as members of one JSON object. The
/// tables are the verb's result, so they are printed even with --quiet.
void print_tables(const std::vector<NamedTable>& tables, const std::string& format, Call& call);

}  // namespace kinalign
