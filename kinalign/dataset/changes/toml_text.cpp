// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/changes/toml_text.h"

#include "kinalign/dataset/catalogue.h"
#include "kinalign/documents/manifest_toml.h"

#include <algorithm>
#include <functional>

namespace kinalign {

namespace {

/// The text with `edit` applied to each line; line ends are kept.
std::string each_line(std::string_view text,
                      const std::function<std::string(std::string_view)>& edit) {
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    out += edit(text.substr(0, end));
    if (end < text.size()) out += '\n';
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

/// Skips blanks. In this and the next functions `at` is the position that was reached in a line.
void skip_blanks(std::string_view line, std::size_t& at) {
  while (at < line.size() && (line[at] == ' ' || line[at] == '\t')) ++at;
}

/// Moves past `word` and returns true if it is next.
bool skip(std::string_view line, std::size_t& at, std::string_view word) {
  if (!line.substr(at).starts_with(word)) return false;
  at += word.size();
  return true;
}

/// The position of the id in a line such as "[subject.03", bare or quoted; npos if the id is not
/// there.
std::size_t id_in_head(std::string_view line, std::string_view table, std::string_view id) {
  std::size_t at = 0;
  skip_blanks(line, at);
  if (!skip(line, at, "[")) return std::string_view::npos;
  skip_blanks(line, at);
  if (!skip(line, at, table)) return std::string_view::npos;
  skip_blanks(line, at);
  if (!skip(line, at, ".")) return std::string_view::npos;
  skip_blanks(line, at);
  const std::string_view quote =
      line.substr(at, 1) == "\"" || line.substr(at, 1) == "'" ? line.substr(at, 1) : "";
  at += quote.size();
  const std::size_t place = at;
  if (!skip(line, at, id) || !skip(line, at, quote)) return std::string_view::npos;
  skip_blanks(line, at);
  // The id must end here, so that "03" is not found in "031". After a dot comes a table within that
  // of the id.
  const bool ends = line.substr(at, 1) == "]" || line.substr(at, 1) == ".";
  return ends ? place : std::string_view::npos;
}

template <class One>
void rename_id(std::vector<One>& all, const std::string& from, const std::string& to) {
  for (One& one : all) {
    if (one.id == from) one.id = to;
  }
}

/// Replaces every occurrence; the search continues after the new text.
void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    text.replace(at, from.size(), to);
    at += to.size();
  }
}

/// Replaces the value of `key = "value"` before the first table.
std::string with_value(const std::string& toml, std::string_view key, const std::string& value) {
  bool is_top = true;
  return each_line(toml, [&](std::string_view line) {
    std::size_t at = 0;
    skip_blanks(line, at);
    // Keys after the first table belong to that table.
    is_top = is_top && line.substr(at, 1) != "[";
    if (!is_top || !skip(line, at, key)) return std::string(line);
    skip_blanks(line, at);
    if (!skip(line, at, "=")) return std::string(line);
    skip_blanks(line, at);
    // Only a plain string on one line is replaced. For other forms the check of the result fails.
    const char quote = at < line.size() ? line[at] : ' ';
    const std::size_t end = line.find(quote, at + 1);
    if ((quote != '"' && quote != '\'') || end == std::string_view::npos) return std::string(line);
    return std::string(line.substr(0, at)) + "\"" + value + "\"" +
           std::string(line.substr(end + 1));
  });
}

}  // namespace

Result<std::string> with_id_renamed(const std::string& toml, const std::string& table,
                                    const std::string& from, const std::string& to,
                                    const std::string& file) {
  // The wanted result is known as values. The edited text is accepted only if parsing it gives
  // these values, so a mistake of the simple search above does no harm.
  Catalogue wanted = KA_TRY(read_catalogue(toml, file));
  if (table == "subject") {
    rename_id(wanted.subjects, from, to);
  } else {
    rename_id(wanted.actions, from, to);
  }
  const std::string edited = each_line(toml, [&](std::string_view line) {
    std::string out(line);
    const std::size_t at = id_in_head(line, table, from);
    return at == std::string_view::npos ? out : out.replace(at, from.size(), to);
  });
  const auto read = read_catalogue(edited, file);
  if (read && catalogue_toml(*read) == catalogue_toml(wanted)) return edited;
  return Failure(Error{file, 0,
                       "[" + table + "." + from +
                           "] as the head of a table, so that it can become [" + table + "." + to +
                           "]",
                       "another form; change the id there by hand, then run the command again"});
}

Result<std::string> manifest_of_renamed(const std::string& toml, const TakeName& from,
                                        const TakeName& to, const std::string& file) {
  // The result is checked in the same way. If the check fails, the whole text is written from the
  // values.
  Manifest wanted = KA_TRY(read_manifest(toml, file));
  for (std::string* path : paths_in(wanted)) replace_all(*path, raw_folder(from), raw_folder(to));
  if (!wanted.subject.empty()) wanted.subject = to.subject;
  if (!wanted.action.empty()) wanted.action = to.action;
  std::string edited = with_value(with_value(toml, "subject", to.subject), "action", to.action);
  replace_all(edited, raw_folder(from), raw_folder(to));
  const auto read = read_manifest(edited, file);
  const std::string text = manifest_toml(wanted);
  return read && manifest_toml(*read) == text ? edited : text;
}

}  // namespace kinalign
