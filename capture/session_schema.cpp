#include "capture/session_schema.h"

#include <string_view>

namespace fude::session_schema {
namespace {

constexpr std::string_view tables_of_any_format[] = {
    "CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID",
    "CREATE TABLE setting(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID",
    "CREATE TABLE axis(device INTEGER NOT NULL, code INTEGER NOT NULL, minimum INTEGER NOT NULL, "
    "maximum INTEGER NOT NULL, fuzz INTEGER NOT NULL, flat INTEGER NOT NULL, resolution INTEGER NOT NULL, "
    "value INTEGER NOT NULL, PRIMARY KEY(device, code)) WITHOUT ROWID",
    "CREATE TABLE action(input INTEGER PRIMARY KEY, time_ns INTEGER NOT NULL, verb TEXT NOT NULL, "
    "arguments TEXT NOT NULL)",
    "CREATE TABLE applied(input INTEGER PRIMARY KEY, step INTEGER NOT NULL)",
    "CREATE TABLE receipt(device INTEGER PRIMARY KEY, expected INTEGER NOT NULL, received INTEGER NOT NULL, "
    "dropped INTEGER NOT NULL)",
    "CREATE TABLE calibration(number INTEGER PRIMARY KEY, name TEXT NOT NULL, toml TEXT NOT NULL)",
    "CREATE TABLE snapshot(step INTEGER PRIMARY KEY, state BLOB NOT NULL)",
};

constexpr std::string_view tables_since_2[] = {
    "CREATE TABLE clock_fit(device INTEGER NOT NULL, part TEXT NOT NULL, first_reading INTEGER NOT NULL, "
    "since_ns INTEGER NOT NULL, first_tick INTEGER NOT NULL, counter_bits INTEGER NOT NULL, "
    "offset_ns INTEGER NOT NULL, tick_s REAL NOT NULL, nominal_tick_s REAL, drift_ppm REAL, "
    "readings INTEGER NOT NULL, outliers INTEGER NOT NULL, residual_p50_s REAL NOT NULL, "
    "residual_p99_s REAL NOT NULL, residual_max_s REAL NOT NULL)",
    "CREATE TABLE passed_over(device INTEGER NOT NULL, what TEXT NOT NULL, count INTEGER NOT NULL)",
};

constexpr std::string_view device_columns =
    "CREATE TABLE device(number INTEGER PRIMARY KEY, identity TEXT NOT NULL, name TEXT NOT NULL, kind TEXT "
    "NOT NULL, "
    "transport TEXT NOT NULL, bus INTEGER NOT NULL, vendor INTEGER NOT NULL, product INTEGER NOT NULL, "
    "version INTEGER NOT NULL, serial TEXT NOT NULL, keys TEXT NOT NULL, properties TEXT NOT NULL, width_mm "
    "REAL, "
    "height_mm REAL, mm_per_count REAL";

constexpr std::string_view transfer_columns =
    "CREATE TABLE transfer(number INTEGER PRIMARY KEY, device INTEGER NOT NULL, time_ns INTEGER NOT NULL, "
    "stamped_by TEXT NOT NULL, direction TEXT NOT NULL, kind TEXT NOT NULL, payload BLOB NOT NULL";

std::string_view word(CellType type) {
  return type == CellType::integer ? "INTEGER" : type == CellType::real ? "REAL" : "TEXT";
}

}  // namespace

std::string create(const SampleTable& table, int of_format) {
  std::string sql = "CREATE TABLE " + table.name + "(input INTEGER PRIMARY KEY, device INTEGER NOT NULL";
  for (const SampleColumn& column : table.columns) {
    if (column.since_format > of_format) continue;
    sql.append(", ")
        .append(column.name)
        .append(" ")
        .append(word(column.type))
        .append(column.optional ? "" : " NOT NULL");
  }
  return sql + ")";
}

std::string insert(const SampleTable& table) {
  std::string sql = "INSERT INTO " + table.name + " VALUES(?,?";
  for (std::size_t i = 0; i < table.columns.size(); ++i) sql += ",?";
  return sql + ")";
}

std::vector<std::string> tables(int of_format) {
  const bool pens_alone = of_format < 2;
  std::vector<std::string> all(std::begin(tables_of_any_format), std::end(tables_of_any_format));
  const std::string clock = ", clock_bits INTEGER, nominal_tick_s REAL, hid_descriptor BLOB NOT NULL";
  all.push_back(std::string(device_columns) + (pens_alone ? "" : clock) + ")");
  all.push_back(std::string(transfer_columns) + (pens_alone ? "" : ", endpoint INTEGER NOT NULL") + ")");
  for (const SampleTable& table : sample_tables())
    if (!pens_alone || table.stream == "pen") all.push_back(create(table, of_format));
  if (!pens_alone) all.insert(all.end(), std::begin(tables_since_2), std::end(tables_since_2));
  return all;
}

}  // namespace fude::session_schema
