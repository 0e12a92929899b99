// SQLite, held safely: statements that finalise themselves, and errors that say what to do.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "signal/result.h"

struct sqlite3;
struct sqlite3_stmt;

namespace fude {

// One prepared statement. Parameters and columns count from 0. A failed bind or step is kept and
// returned by the next step().
class Statement {
 public:
  explicit Statement(sqlite3_stmt* statement) : statement_(statement) {}

  Statement& bind(std::int64_t value);
  Statement& bind(double value);
  Statement& bind(std::string_view text);
  Statement& bind(std::span<const std::byte> blob);
  Statement& bind_null();

  // True while a row is there; after false the statement is ready to be bound again.
  Result<bool> step();

  bool is_null(int column) const;
  std::int64_t integer(int column) const;
  double real(int column) const;  // 0 for what is no finite number
  std::string text(int column) const;
  std::vector<std::byte> blob(int column) const;

 private:
  struct Finalise {
    void operator()(sqlite3_stmt* s) const;
  };
  std::unique_ptr<sqlite3_stmt, Finalise> statement_;
  int next_ = 1;
  int bind_error_ = 0;
};

enum class OpenMode { create, append, read };

// A database file. One thread at a time.
class Database {
 public:
  // Opens defensively: no triggers or views of strangers run, sizes are bounded, cells are checked.
  // Errors: not_found, no_access, busy (another program writes it), malformed (no database).
  static Result<Database> open(const std::filesystem::path& path, OpenMode mode);

  Result<void> run(const std::string& sql);
  Result<Statement> prepare(std::string_view sql);
  std::int64_t last_row() const;
  const std::filesystem::path& path() const { return path_; }

 private:
  struct Close {
    void operator()(sqlite3* db) const;
  };
  Database(sqlite3* db, std::filesystem::path path) : db_(db), path_(std::move(path)) {}
  std::unique_ptr<sqlite3, Close> db_;
  std::filesystem::path path_;
};

}  // namespace fude
