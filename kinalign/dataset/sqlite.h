// SPDX-License-Identifier: Apache-2.0
// SQLite's C interface with ownership and errors (sqlite.org/c3ref/intro.html).
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/view/table.h"

#include <memory>
#include <string>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace kinalign::sqlite {

class Database;

/// One prepared statement, which can be run repeatedly.
class Statement {
 public:
  /// Sets the values for the statement's '?', in order.
  Result<void> bind(const std::vector<Cell>& values);
  /// Goes to the next row. Returns false after the last row; then values can be bound again.
  Result<bool> step();
  /// Runs a statement that returns no rows.
  Result<void> run(const std::vector<Cell>& values);

  std::size_t columns() const;
  std::string column_name(std::size_t column) const;
  Cell at(std::size_t column) const;

 private:
  friend class Database;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  sqlite3* database_ = nullptr;
};

enum class Access { read_write, in_memory };

/// An open database. Statements must not outlive it. Only one thread may use it at a time.
class Database {
 public:
  /// Opens a database. Waits at most ten seconds while another process writes.
  static Result<Database> open(const std::string& path, Access access);

  Result<void> run(const std::string& sql);  // any number of statements
  Result<Statement> prepare(const std::string& sql) const;
  /// Like prepare(), but refuses statements that write.
  Result<Statement> prepare_reading(const std::string& sql) const;

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::unique_ptr<sqlite3, Close> database_;
  std::string path_;
};

}  // namespace kinalign::sqlite
