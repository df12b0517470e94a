// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/dataset_page/table_html.h"

#include "kinalign/view/page/page_html.h"

#include <fmt/format.h>

#include <string_view>
#include <vector>

namespace kinalign {

std::string table_html(const Table& table) {
  // The style right-aligns cells; columns of words have a class that left-aligns them.
  const std::vector<bool> right = numeric_columns(table);
  const auto cell = [&](std::string_view tag, std::size_t column, const std::string& text) {
    return fmt::format("<{0}{1}>{2}</{0}>", tag, right[column] ? "" : " class=\"text\"",
                       escaped(text));
  };
  std::string out = "<figure><div class=\"scroll\"><table><thead><tr>";
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    out += cell("th", c, table.columns[c].title);
  }
  out += "</tr></thead><tbody>";
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    // The style separates the row of sums from the others.
    out += table.has_sum && r + 1 == table.rows.size() ? "<tr class=\"sum\">" : "<tr>";
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      out += cell("td", c, cell_text(table.rows[r][c], table.columns[c]));
    }
    out += "</tr>";
  }
  return out + "</tbody></table></div><figcaption>" + escaped(table.caption) +
         ".</figcaption></figure>\n";
}

}  // namespace kinalign
