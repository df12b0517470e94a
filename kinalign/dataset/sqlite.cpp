// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/sqlite.h"

#include <sqlite3.h>

#include <type_traits>

namespace kinalign::sqlite {

namespace {

// Another process may be writing. It locks the index for one update only.
constexpr int longest_wait_ms = 10'000;

/// A failure with SQLite's own message, which says best what is wrong with a statement.
Failure failure(sqlite3* database, const std::string& file, const std::string& expected) {
  return Failure(
      Error{file, 0, expected, database == nullptr ? "no memory" : sqlite3_errmsg(database)});
}

/// A callback for sqlite3_set_authorizer: it allows a statement only to read.
// NOLINTNEXTLINE(readability-function-size): SQLite asks with six arguments
int allow_reading(void*, int action, const char*, const char*, const char*, const char*) {
  const bool reads = action == SQLITE_SELECT || action == SQLITE_READ ||
                     action == SQLITE_FUNCTION || action == SQLITE_RECURSIVE;
  return reads ? SQLITE_OK : SQLITE_DENY;
}

}  // namespace

void Statement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
void Database::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

/// Sets the values of a statement. The statement is reset first, because it can't be bound
/// otherwise, also after an error.
Result<void> Statement::bind(const std::vector<Cell>& values) {
  sqlite3_reset(statement_.get());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const int at = static_cast<int>(i) + 1;
    const int code = std::visit(
        [&](const auto& value) {
          using Value = std::decay_t<decltype(value)>;
          if constexpr (std::is_same_v<Value, std::int64_t>) {
            return sqlite3_bind_int64(statement_.get(), at, value);
          } else if constexpr (std::is_same_v<Value, double>) {
            return sqlite3_bind_double(statement_.get(), at, value);
          } else if constexpr (std::is_same_v<Value, std::string>) {
            // SQLite copies the text, so the values may end before the statement.
            return sqlite3_bind_text(statement_.get(), at, value.data(),
                                     static_cast<int>(value.size()), SQLITE_TRANSIENT);
          } else {
            return sqlite3_bind_null(statement_.get(), at);
          }
        },
        values[i]);
    if (code != SQLITE_OK) return failure(database_, "", "values for a statement");
  }
  return {};
}

Result<bool> Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  return failure(database_, "", "an answer");
}

Result<void> Statement::run(const std::vector<Cell>& values) {
  KA_TRY(bind(values));
  KA_TRY(step());
  return {};
}

std::size_t Statement::columns() const {
  return static_cast<std::size_t>(sqlite3_column_count(statement_.get()));
}

std::string Statement::column_name(std::size_t column) const {
  const char* name = sqlite3_column_name(statement_.get(), static_cast<int>(column));
  return name == nullptr ? "" : name;
}

/// The value of a column, in the type that SQLite states for it.
Cell Statement::at(std::size_t column) const {
  const int c = static_cast<int>(column);
  switch (sqlite3_column_type(statement_.get(), c)) {
    case SQLITE_INTEGER:
      return static_cast<std::int64_t>(sqlite3_column_int64(statement_.get(), c));
    case SQLITE_FLOAT:
      return sqlite3_column_double(statement_.get(), c);
    case SQLITE_NULL:
      return std::monostate{};
    default: {
      const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), c));
      const int size = sqlite3_column_bytes(statement_.get(), c);
      return text == nullptr ? std::string() : std::string(text, static_cast<std::size_t>(size));
    }
  }
}

Result<Database> Database::open(const std::string& path, Access access) {
  Database out;
  out.path_ = path;
  sqlite3* opened = nullptr;
  const int flags = access == Access::in_memory ? SQLITE_OPEN_MEMORY : 0;
  const int code = sqlite3_open_v2(path.c_str(), &opened,
                                   SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | flags, nullptr);
  // Even if the call fails, it may have made an object, which must be closed.
  out.database_.reset(opened);
  if (code != SQLITE_OK) return failure(opened, path, "an index that can be opened");
  sqlite3_busy_timeout(opened, longest_wait_ms);
  return out;
}

Result<void> Database::run(const std::string& sql) {
  if (sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK) return {};
  return failure(database_.get(), path_, "an index that can be used");
}

/// Prepares exactly one statement. Further text after it is an error.
Result<Statement> Database::prepare(const std::string& sql) const {
  sqlite3_stmt* made = nullptr;
  const char* behind = nullptr;
  const int code = sqlite3_prepare_v2(database_.get(), sql.c_str(),
                                      static_cast<int>(sql.size()) + 1, &made, &behind);
  Statement out;
  out.statement_.reset(made);
  out.database_ = database_.get();
  if (code != SQLITE_OK) return failure(database_.get(), "", "a statement of SQL");
  if (made == nullptr) return Failure(Error{"", 0, "a statement of SQL", "nothing"});
  const std::string_view rest(behind);
  if (rest.find_first_not_of(" \t\r\n;") != std::string_view::npos) {
    return Failure(Error{"", 0, "one statement of SQL", "more text after it: " + shown(rest)});
  }
  return out;
}

Result<Statement> Database::prepare_reading(const std::string& sql) const {
  // SQLite calls allow_reading() while it parses the statement. Afterwards the index may write
  // again.
  sqlite3_set_authorizer(database_.get(), &allow_reading, nullptr);
  auto made = prepare(sql);
  sqlite3_set_authorizer(database_.get(), nullptr, nullptr);
  const bool is_denied = !made && made.error().found == "not authorized";
  // A statement without columns is no SELECT, even if it was allowed.
  const bool is_other =
      made && (made->columns() == 0 || sqlite3_stmt_readonly(made->statement_.get()) == 0);
  if (is_denied || is_other) {
    return Failure(Error{"", 0, "a SELECT", "another statement"});
  }
  return made;
}

}  // namespace kinalign::sqlite
