#include "capture/database.h"

#include <sqlite3.h>

#include <cmath>

namespace fude {
namespace {

constexpr int longest_value_bytes = 256 * 1024 * 1024;  // a snapshot of a large wet sheet
constexpr int longest_statement_bytes = 100'000;

Error describe(int code, const std::filesystem::path& path, std::string_view detail) {
  const std::string name = path.string();
  switch (code & 0xff) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return {Fault::busy, name + " is in use by another program; close that one first"};
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return {Fault::no_access,
              name + " cannot be written; check the permissions of the file and its folder"};
    case SQLITE_CANTOPEN:
      return {Fault::no_access, name + " cannot be opened; check that the folder exists and may be read"};
    case SQLITE_FULL:
      return {Fault::storage, "the disk is full: make room; what " + name + " already holds is kept"};
    case SQLITE_IOERR:
      return {Fault::storage, "reading or writing " + name + " failed; check the disk"};
    case SQLITE_NOTADB:
      return {Fault::malformed, name + " is not a session file; use 'fude import' for other formats"};
    case SQLITE_CORRUPT:
      return {Fault::malformed, name + " is damaged; 'sqlite3 " + name + " .recover' may save what is left"};
    case SQLITE_TOOBIG:
      return {Fault::malformed, name + " holds a value that is too large"};
    default:
      return {Fault::malformed, name + ": " + std::string(detail)};
  }
}

}  // namespace

void Statement::Finalise::operator()(sqlite3_stmt* s) const { sqlite3_finalize(s); }
void Database::Close::operator()(sqlite3* db) const { sqlite3_close_v2(db); }

Statement& Statement::bind(std::int64_t value) {
  bind_error_ |= sqlite3_bind_int64(statement_.get(), next_++, value);
  return *this;
}
Statement& Statement::bind(double value) {
  bind_error_ |= sqlite3_bind_double(statement_.get(), next_++, value);
  return *this;
}
Statement& Statement::bind(std::string_view text) {
  bind_error_ |=
      sqlite3_bind_text64(statement_.get(), next_++, text.data(), text.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
  return *this;
}
Statement& Statement::bind(std::span<const std::byte> blob) {
  bind_error_ |= sqlite3_bind_blob64(statement_.get(), next_++,
                                     blob.empty() ? "" : static_cast<const void*>(blob.data()), blob.size(),
                                     SQLITE_TRANSIENT);
  return *this;
}
Statement& Statement::bind_null() {
  bind_error_ |= sqlite3_bind_null(statement_.get(), next_++);
  return *this;
}

Result<bool> Statement::step() {
  sqlite3* db = sqlite3_db_handle(statement_.get());
  const int code = bind_error_ ? bind_error_ : sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  const std::string detail = sqlite3_errmsg(db);
  sqlite3_reset(statement_.get());
  sqlite3_clear_bindings(statement_.get());
  next_ = 1;
  bind_error_ = 0;
  if (code == SQLITE_DONE) return false;
  const char* name = sqlite3_db_filename(db, "main");
  return tl::unexpected(describe(code, name ? name : "", detail));
}

bool Statement::is_null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}
std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }
double Statement::real(int column) const {
  const double value = sqlite3_column_double(statement_.get(), column);
  return std::isfinite(value) ? value : 0;
}
std::string Statement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  return text ? std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column)))
              : "";
}
std::vector<std::byte> Statement::blob(int column) const {
  const auto* bytes = static_cast<const std::byte*>(sqlite3_column_blob(statement_.get(), column));
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  return bytes ? std::vector<std::byte>(bytes, bytes + size) : std::vector<std::byte>{};
}

Result<Database> Database::open(const std::filesystem::path& path, OpenMode mode) {
  std::error_code ignored;
  if (mode != OpenMode::create && !std::filesystem::exists(path, ignored))
    return failure(Fault::not_found, path.string() + " does not exist; give the path of a .fude session");
  if (mode != OpenMode::create && !std::filesystem::is_regular_file(path, ignored))
    return failure(Fault::malformed, path.string() + " is not a file; give the path of a .fude session");
  // A session that was not closed has a write-ahead log beside it, which only a writer can fold in.
  const bool unfinished = std::filesystem::exists(path.string() + "-wal", ignored);
  const int flags = mode == OpenMode::create                 ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE
                    : mode == OpenMode::append || unfinished ? SQLITE_OPEN_READWRITE
                                                             : SQLITE_OPEN_READONLY;
  sqlite3* raw = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &raw, flags, nullptr);
  Database db(raw, path);
  if (code != SQLITE_OK) return tl::unexpected(describe(code, path, raw ? sqlite3_errmsg(raw) : "no memory"));
  sqlite3_db_config(raw, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(raw, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(raw, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(raw, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  sqlite3_limit(raw, SQLITE_LIMIT_LENGTH, longest_value_bytes);
  sqlite3_limit(raw, SQLITE_LIMIT_SQL_LENGTH, longest_statement_bytes);
  sqlite3_limit(raw, SQLITE_LIMIT_ATTACHED, 0);
  sqlite3_busy_timeout(raw, 500);
  if (auto r = db.run("PRAGMA cell_size_check=ON; PRAGMA mmap_size=0;"); !r) return tl::unexpected(r.error());
  return db;
}

Result<void> Database::run(const std::string& sql) {
  if (const int code = sqlite3_exec(db_.get(), sql.c_str(), nullptr, nullptr, nullptr); code != SQLITE_OK)
    return tl::unexpected(describe(code, path_, sqlite3_errmsg(db_.get())));
  return {};
}

Result<Statement> Database::prepare(std::string_view sql) {
  sqlite3_stmt* statement = nullptr;
  const int code =
      sqlite3_prepare_v2(db_.get(), sql.data(), static_cast<int>(sql.size()), &statement, nullptr);
  if (code != SQLITE_OK) return tl::unexpected(describe(code, path_, sqlite3_errmsg(db_.get())));
  return Statement(statement);
}

std::int64_t Database::last_row() const { return sqlite3_last_insert_rowid(db_.get()); }

}  // namespace fude
