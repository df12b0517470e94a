// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/field_text.h"
#include "apps/kinalign/dataset/dataset_folder.h"
#include "apps/kinalign/dataset/table_output.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/core/nearest_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace kinalign {

namespace {

// These columns answer the first question about a data set: which takes it has, and which of them
// are bad.
constexpr const char* usual_columns =
    "name,subject,class,action,frames,seconds,kinect,imu,residual_cm,verdict";

/// The options that `list` and `query` share.
struct Shown {
  std::vector<std::string> folder;
  std::string columns = usual_columns, sort, format = "text";
  std::int64_t limit = 0;
};

/// The flags that `list` and `query` share.
Fields fields_of(Shown& o) {
  return {text_flag("columns", "comma-separated, or all", &o.columns, "COLUMNS"),
          text_flag(
              "sort",
              "column to sort by; with - at its end, largest first: frames-; verdict: worst first",
              &o.sort, "COLUMN"),
          {"limit", "largest number of rows; 0: all", &o.limit, 0.0, 1e12},
          format_field(o.format)};
}

/// The options of `kinalign dataset list`: filters for people who do not know SQL. A take is listed
/// if it passes all given filters.
struct List {
  Shown shown;
  std::string subject, class_id, action, verdict;
  std::vector<std::string> modality;
};

/// The options of `kinalign dataset query`: either a condition or a whole SELECT of SQL.
struct Query {
  Shown shown;
  std::vector<std::string> words;
};

/// The columns of the view `takes`, which users name in --columns, --sort and conditions.
std::vector<std::string> column_names() {
  std::vector<std::string> names;
  for (const TableColumn& column : DatasetIndex::columns()) names.push_back(column.key);
  return names;
}

/// Returns the column's name if it exists. SQL does not allow '?' in place of a column's name, so
/// the name becomes part of the query's text. Only known names may do so.
Result<std::string> checked_column(const std::string& name, const char* flag) {
  const std::vector<std::string> known = column_names();
  if (std::find(known.begin(), known.end(), name) != known.end()) return name;
  Error error = unknown_name(name, "a column", known);
  error.file = flag;
  return Failure(std::move(error));
}

/// Turns the columns of a flag into text for a SELECT: "name,frames" gives "name, frames".
Result<std::string> chosen_columns(const std::string& text) {
  if (text == "all") return fmt::format("{}", fmt::join(column_names(), ", "));
  // An empty name between two commas is refused as an unknown column.
  std::vector<std::string> out;
  for (const std::string& name : split_at_commas(text)) {
    out.push_back(KA_TRY(checked_column(name, "--columns")));
  }
  return fmt::format("{}", fmt::join(out, ", "));
}

/// The text after "order by". Verdicts are sorted by severity and not by the alphabet.
Result<std::string> order_text(const std::string& sort) {
  if (sort.empty()) return std::string("name");
  // The minus for descending order stands at the end, since a minus in front would look like a
  // flag.
  const bool down = sort.ends_with('-');
  const std::string column =
      KA_TRY(checked_column(sort.substr(0, sort.size() - (down ? 1 : 0)), "--sort"));
  // By the alphabet "good" would stand between "bad" and "usable".
  const std::string key = column == "verdict"
                              ? "case verdict when 'bad' then 0 when 'usable' then 1 else 2 end"
                              : column;
  // Equal rows are sorted by name, so that their order is always the same.
  return key + (down ? " desc" : "") + ", name";
}

/// The SELECT for the options. `where`: a condition; empty: all takes.
Result<std::string> select_text(const Shown& o, const std::string& where) {
  std::string sql = "select " + KA_TRY(chosen_columns(o.columns)) + " from takes";
  if (!where.empty()) sql += " where " + where;
  sql += " order by " + KA_TRY(order_text(o.sort));
  if (o.limit > 0) sql += fmt::format(" limit {}", o.limit);
  return sql;
}

/// Runs the SELECT and prints its table. `values`: the values for the '?' in the text. The exit
/// code is 1 if a summary could not be read, because the table then lacks a take.
Result<int> show(const Shown& o, const DatasetIndex& index, const std::string& sql,
                 const std::vector<Cell>& values, Call& call) {
  const Table table = KA_TRY(index.select(sql, values));
  print_tables({{"takes", table}}, o.format, call);
  // Only the format "text" gets a note below the table. Programs read the other formats.
  if (o.format == "text") KA_TRY(print_not_built(index, folder_of(o.folder), call));
  return index.findings().empty() ? 0 : 1;
}

/// The command line of `kinalign dataset list`.
Usage describe_list(List& o) {
  Usage usage;
  usage.positionals = {folder_word(o.shown.folder)};
  usage.flags = {
      text_flag("subject", "takes of this person: 03 or sub-03", &o.subject, "ID"),
      text_flag("class", "takes of this class of actions", &o.class_id, "ID"),
      text_flag("action", "takes of this action", &o.action, "ID"),
      choice_flag("modality", "takes with this modality; may be repeated", &o.modality,
                  {"mocap", "kinect", "imu"}),
      choice_flag("verdict", "takes of this verdict", &o.verdict, {"good", "usable", "bad"})};
  const Fields shown = fields_of(o.shown);
  usage.flags.insert(usage.flags.end(), shown.begin(), shown.end());
  return usage;
}

/// The ids of people, classes or actions. Each of these structures has a member `id`.
std::vector<std::string> ids_of(const auto& described) {
  std::vector<std::string> ids;
  ids.reserve(described.size());
  for (const auto& one : described) ids.push_back(one.id);
  return ids;
}

/// Refuses a filter by an id that occurs neither in dataset.toml nor in a take: an empty table
/// would hide a typing error. `known`: the ids of dataset.toml; takes may have further ids.
Result<void> check_id(const DatasetIndex& index, const std::string& column, const std::string& id,
                      const std::vector<std::string>& known) {
  if (id.empty() || std::find(known.begin(), known.end(), id) != known.end()) return {};
  const Table takes =
      KA_TRY(index.select("select name from takes where " + column + " = ? limit 1", {id}));
  if (!takes.rows.empty()) return {};
  Error error = unknown_name(id, "an id of dataset.toml, [" + column + ".ID]", known);
  error.file = "--" + column;
  return Failure(std::move(error));
}

/// Lists the takes that pass all given filters.
Result<int> run_list(List& o, Call& call) {
  const DatasetIndex index = KA_TRY(open_index(folder_of(o.shown.folder), call));
  // The index calls a person "03"; the names of takes and folders have "sub-03".
  if (o.subject.starts_with("sub-")) o.subject.erase(0, 4);
  KA_TRY(check_id(index, "subject", o.subject, ids_of(index.catalogue().subjects)));
  KA_TRY(check_id(index, "class", o.class_id, ids_of(index.catalogue().classes)));
  KA_TRY(check_id(index, "action", o.action, ids_of(index.catalogue().actions)));
  std::string where;
  // Each value is bound to a '?' and does not become part of the query's text. A value can
  // therefore not change the query.
  std::vector<Cell> values;
  const auto want = [&](const std::string& column, const std::string& value) {
    if (value.empty()) return;
    where += (where.empty() ? "" : " and ") + column + " = ?";
    values.emplace_back(value);
  };
  want("subject", o.subject);
  want("class", o.class_id);
  want("action", o.action);
  want("verdict", o.verdict);
  for (const std::string& modality : o.modality) {
    // The column of a modality, such as kinect, has the number of its frames.
    where += (where.empty() ? "" : " and ") + modality + " > 0";
  }
  return show(o.shown, index, KA_TRY(select_text(o.shown, where)), values, call);
}

/// True if the text is a whole SELECT, false if it is a condition. A SELECT may also begin with
/// "with".
bool is_select(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return false;
  std::string word(text.substr(begin, 6));
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return word == "select" || word.starts_with("with ");
}

/// Refuses flags that choose or sort columns together with a SELECT that the user wrote: the SELECT
/// does so itself.
Result<void> check_query(const Query& o, const Sources& given) {
  if (!is_select(o.words.front())) return {};
  for (const auto& [name, flag] : {std::pair("columns", "--columns"), std::pair("sort", "--sort"),
                                   std::pair("limit", "--limit")}) {
    if (!given.contains(name)) continue;
    return Failure(
        Error{flag, 0, "this flag only with a condition: a whole SELECT has its own", "a SELECT"});
  }
  return {};
}

// A query has the output flags of `list`, but none of its filters.
Usage describe_query(Query& o) {
  Usage usage;
  usage.positionals = {folder_word(o.shown.folder),
                       {"CONDITION", "an SQL condition, or a whole SELECT", &o.words}};
  usage.flags = fields_of(o.shown);
  usage.check = [&o](const Common&, const Sources& given) { return check_query(o, given); };
  return usage;
}

/// Runs a query. If the query fails, the advice lists the columns.
Result<int> run_query(Query& o, Call& call) {
  const std::string& words = o.words.front();
  call.console.if_it_fails([](const Error&) -> std::vector<std::string> {
    return {"columns of takes: " + fmt::format("{}", fmt::join(column_names(), ", ")),
            "streams has the columns take, name, modality, columns, valid, inferred, gaps, gap_s, "
            "interval_ms, nodes"};
  });
  const std::string sql =
      // The brackets turn any text of the user into one condition.
      is_select(words) ? words : KA_TRY(select_text(o.shown, "(" + words + ")"));
  // DatasetIndex refuses every statement that writes, so a SELECT of the user can't damage the
  // index.
  const DatasetIndex index = KA_TRY(open_index(folder_of(o.shown.folder), call));
  return show(o.shown, index, sql, {}, call);
}

}  // namespace

/// The verb `kinalign dataset list`.
Verb dataset_list_verb() {
  return make_verb<List>(
      {.name = "dataset list",
       .summary = "the takes of a data set, by person, class, action, modality or verdict",
       .text = "",
       .examples = {{"kinalign dataset list walks", "all takes"},
                    {"kinalign dataset list walks --class S2 --modality imu --sort frames-",
                     "Baduanjin takes with nodes, longest first"},
                    {"kinalign dataset list walks --columns name,worst --verdict bad",
                     "what is wrong with the bad takes"}},
       .common = {"json"}},
      describe_list, run_list);
}

/// The verb `kinalign dataset query`.
Verb dataset_query_verb() {
  return make_verb<Query>(
      {.name = "dataset query",
       .summary = "query the index of a data set in SQL",
       .text = "Takes a condition on the columns of `takes`, or a whole SELECT from `takes` and "
               "`streams`. A query can't change anything.",
       .examples = {{"kinalign dataset query walks \"class = 'S2' and frames > 6000\"",
                     "the takes that meet the condition"},
                    {"kinalign dataset query walks \"select subject, sum(seconds) / 60 as minutes "
                     "from takes group by subject\" --format csv",
                     "minutes per person"}},
       .common = {"json"}},
      describe_query, run_query);
}

}  // namespace kinalign
