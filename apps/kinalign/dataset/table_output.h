// SPDX-License-Identifier: Apache-2.0
// Tables on stdout, as --format and --json ask for them.
#pragma once

#include "apps/cli/console.h"
#include "apps/cli/verb.h"

#include "kinalign/view/table.h"

#include <string>
#include <vector>

namespace kinalign {

/// --format: how a table is printed; with --json it is JSON whatever the flag says.
Field format_field(std::string& format);
/// Prints tables one below the other as `format` says, or as members of one JSON object.
struct NamedTable {
  std::string name;
  Table table;
};
void print_tables(const std::vector<NamedTable>& tables, const std::string& format, Call& call);

/// Prints a table as `format` says, or as the member `name` of a JSON object.
void print_table(const Table& table, const std::string& format, const std::string& name,
                 Call& call);

}  // namespace kinalign
