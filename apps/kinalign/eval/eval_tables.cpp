// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/eval/eval_tables.h"

#include "apps/cli/console.h"
#include "apps/kinalign/dataset/table_output.h"
#include "apps/kinalign/text/counts_text.h"

#include "kinalign/evaluate/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>

namespace kinalign {

namespace {

/// With fewer people the table has no interval, because it would be too narrow.
constexpr std::size_t least_for_interval = 8;
/// The number of marks in one table on a terminal. Further marks follow in further tables.
constexpr std::size_t most_columns = 6;
/// If there are more tests, they are written to files but not printed.
constexpr std::size_t most_printed_tests = 12;

/// The number of people (or folds) that have a value in at least one row.
std::size_t count_of_values(const std::vector<MethodMarks>& rows) {
  std::set<std::string> all;
  for (const MethodMarks& row : rows) {
    for (const auto& [mark, values] : row.marks) {
      for (const auto& [name, value] : values) all.insert(name);
    }
  }
  return all.size();
}

/// Adds the mean and the two ends of its interval. Without an interval, adds the mean and, if there
/// are several values, the standard deviation.
void put_mean(const std::vector<double>& values, bool has_interval, std::vector<Cell>& row) {
  if (values.empty()) {
    row.resize(row.size() + (has_interval ? 3 : 2));
    return;
  }
  row.push_back(cell_of(mean_of(values)));
  if (has_interval) {
    const MeanInterval interval = bootstrap_mean(values);
    row.insert(row.end(), {Cell(interval.low), Cell(interval.high)});
  } else {
    row.push_back(values.size() > 1 ? Cell(deviation(values)) : Cell());
  }
}

/// The table of the means of all rows, with these columns.
Table table_of(const EvalRows& all, std::span<const MarkColumn> columns) {
  const std::size_t count = count_of_values(all.rows);
  const Comparison& comparison = all.comparison;
  const bool has_interval = comparison.over == "people" && count >= least_for_interval;
  Table out;
  out.caption =
      all.folds + ": mean and " + (has_interval ? "its 95 % interval" : "standard deviation") +
      " over " +
      (comparison.over == "people" ? counted(count, "person", "people") : comparison.over);
  if (!comparison.note.empty()) out.caption += "; " + comparison.note;
  out.columns = {{"method", "method"}};
  for (const auto& [key, title, decimals] : columns) {
    out.columns.push_back({key, title, decimals});
    if (has_interval) {
      out.columns.push_back({key + "_low", "from", decimals});
      out.columns.push_back({key + "_high", "to", decimals});
    } else {
      out.columns.push_back({key + "_sd", "±", decimals});
    }
  }
  for (const MethodMarks& marks : all.rows) {
    auto& row = out.rows.emplace_back(std::vector<Cell>{marks.label()});
    for (const MarkColumn& column : columns) {
      put_mean(marks.values(column.key), has_interval, row);
    }
  }
  return out;
}

/// The table of single values, with a row for each person or fold.
Table people_of(const EvalRows& all) {
  Table out;
  out.columns = {{"method", "method"}, {"tested", "tested"}};
  for (const auto& [key, title, decimals] : all.comparison.columns) {
    out.columns.push_back({key, title, decimals});
  }
  for (const MethodMarks& marks : all.rows) {
    std::map<std::string, std::vector<Cell>> people;
    for (std::size_t c = 0; c < all.comparison.columns.size(); ++c) {
      const auto found = marks.marks.find(all.comparison.columns[c].key);
      if (found == marks.marks.end()) continue;
      for (const auto& [name, mean] : found->second) {
        auto& row = people[name];
        row.resize(all.comparison.columns.size());
        row[c] = mean.value_or(0.0);
      }
    }
    for (auto& [name, values] : people) {
      auto& row = out.rows.emplace_back(std::vector<Cell>{marks.label(), name});
      row.insert(row.end(), values.begin(), values.end());
    }
  }
  return out;
}

/// The table of paired tests between each two methods, for each mark.
Table tests_of(const EvalRows& all) {
  Table out;
  out.caption = "differences of two methods, with Wilcoxon's signed-rank test over " +
                all.comparison.over + "; Holm's correction over the tests of a mark";
  out.columns = {{"first", "first"},
                 {"second", "second"},
                 {"mark", "mark"},
                 {"pairs", "pairs"},
                 {"difference", "first − second", 2},
                 {"p", "p", 4},
                 {"p_corrected", "p, corrected", 4}};
  for (const MarkColumn& column : all.comparison.columns) {
    for (const PairedTest& test : paired_tests(all.rows, column.key)) {
      out.rows.push_back({all.rows[test.first].label(), all.rows[test.second].label(), column.key,
                          static_cast<std::int64_t>(test.people), test.difference, test.p,
                          test.corrected});
    }
  }
  return out;
}

/// The table of the mean error of each joint. It has no rows if the task does not mark joints one
/// by one.
Table joints_of(const EvalRows& all) {
  Table out;
  out.caption = "position of each joint, cm";
  out.columns = {{"method", "method"}};
  for (const auto& [key, title, decimals] : all.comparison.joints) {
    out.columns.push_back({key, title, decimals});
  }
  for (const MethodMarks& marks : all.rows) {
    if (all.comparison.joints.empty()) break;
    auto& row = out.rows.emplace_back(std::vector<Cell>{marks.label()});
    for (const MarkColumn& joint : all.comparison.joints) {
      row.push_back(cell_of(mean_of(marks.values(joint.key))));
    }
  }
  return out;
}

/// The table of the radii that methods state, and of the share of errors within them. It has no
/// rows if no method states radii.
Table radii_of(const EvalRows& all) {
  Table out;
  out.caption =
      "stated 90 % radii over all people, and the single radius for all joints that contains the "
      "same fraction";
  out.columns = {{"method", "method"},           {"part", "part"},
                 {"cells", "positions"},         {"covered_percent", "within, %", 1},
                 {"radius_cm", "stated, cm", 2}, {"one_radius_cm", "single radius, cm", 2}};
  for (const MethodMarks& marks : all.rows) {
    if (marks.radii.empty()) continue;
    auto parts = marks.radii;
    for (const auto& [part, radii] : marks.radii) parts["all"].add(radii);
    for (const auto& [part, radii] : parts) {
      out.rows.push_back({marks.label(), part, static_cast<std::int64_t>(radii.cells),
                          100.0 * radii.covered(), 100.0 * radii.mean_radius_m(),
                          100.0 * radii.one_radius_m()});
    }
  }
  return out;
}

/// Writes a table as .md, .tex, .csv and .json.
Result<void> write_all(const Table& table, const std::string& name, Call& call) {
  return write_table(
      table, call.common.out + "/" + name,
      {TableFormat::markdown, TableFormat::latex, TableFormat::csv, TableFormat::json}, call);
}

}  // namespace

Result<void> write_tables(const EvalRows& all, Call& call) {
  KA_TRY(write_all(table_of(all, all.comparison.columns), "table", call));
  KA_TRY(write_all(people_of(all), "people", call));
  for (const NamedTable& table :
       {NamedTable{"joints", joints_of(all)}, NamedTable{"radii", radii_of(all)}}) {
    if (!table.table.rows.empty()) KA_TRY(write_all(table.table, table.name, call));
  }
  return write_all(tests_of(all), "tests", call);
}

void print_tables(const EvalRows& all, const std::string& format, Call& call) {
  const std::span<const MarkColumn> columns = all.comparison.columns;
  const bool is_text = format == "text" && !call.console.prints_json();
  const std::size_t width = is_text ? most_columns : columns.size();
  std::vector<NamedTable> tables;
  for (std::size_t begin = 0; begin < columns.size(); begin += width) {
    const auto some = columns.subspan(begin, std::min(width, columns.size() - begin));
    tables.push_back({"rows", table_of(all, some)});
    if (begin > 0) tables.back().table.caption.clear();
  }
  const Table tests = tests_of(all);
  const bool is_shown = !tests.rows.empty() && tests.rows.size() <= most_printed_tests;
  if (const Table radii = radii_of(all); !radii.rows.empty()) tables.push_back({"radii", radii});
  if (is_shown || call.console.prints_json()) tables.push_back({"tests", tests});
  if (call.console.prints_json()) {
    tables.push_back({"people", people_of(all)});
    if (const Table joints = joints_of(all); !joints.rows.empty()) {
      tables.push_back({"joints", joints});
    }
  }
  print_tables(tables, format, call);
  if (!is_shown && !tests.rows.empty() && format == "text") {
    call.console.print(fmt::format("\npaired tests: {}/tests.md\n", harmless(call.common.out)));
  }
}

}  // namespace kinalign
