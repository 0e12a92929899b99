// The tables of a session file. docs/session-format.md explains every column.
#pragma once

namespace fude::session_schema {

inline constexpr int application_id = 0x66756465;  // "fude"
inline constexpr int format = 1;

inline constexpr const char* tables[] = {
    "CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID",
    "CREATE TABLE setting(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID",
    "CREATE TABLE device(number INTEGER PRIMARY KEY, identity TEXT NOT NULL, name TEXT NOT NULL, kind TEXT "
    "NOT NULL, "
    "transport TEXT NOT NULL, bus INTEGER NOT NULL, vendor INTEGER NOT NULL, product INTEGER NOT NULL, "
    "version INTEGER NOT NULL, serial TEXT NOT NULL, keys TEXT NOT NULL, properties TEXT NOT NULL, width_mm "
    "REAL, "
    "height_mm REAL, mm_per_count REAL)",
    "CREATE TABLE axis(device INTEGER NOT NULL, code INTEGER NOT NULL, minimum INTEGER NOT NULL, "
    "maximum INTEGER NOT NULL, fuzz INTEGER NOT NULL, flat INTEGER NOT NULL, resolution INTEGER NOT NULL, "
    "value INTEGER NOT NULL, PRIMARY KEY(device, code)) WITHOUT ROWID",
    "CREATE TABLE transfer(number INTEGER PRIMARY KEY, device INTEGER NOT NULL, time_ns INTEGER NOT NULL, "
    "stamped_by TEXT NOT NULL, direction TEXT NOT NULL, kind TEXT NOT NULL, payload BLOB NOT NULL)",
    "CREATE TABLE pen_sample(input INTEGER PRIMARY KEY, device INTEGER NOT NULL, time_ns INTEGER NOT NULL, "
    "stamped_by TEXT NOT NULL, sequence INTEGER NOT NULL, device_tick INTEGER, tool TEXT NOT NULL, "
    "tool_serial INTEGER NOT NULL, tool_id INTEGER NOT NULL, in_proximity INTEGER NOT NULL, "
    "in_contact INTEGER NOT NULL, x_counts REAL NOT NULL, y_counts REAL NOT NULL, pressure REAL NOT NULL, "
    "pressure_raw INTEGER NOT NULL, tilt_x_rad REAL, tilt_y_rad REAL, rotation_rad REAL, distance REAL, "
    "wheel REAL, "
    "buttons INTEGER NOT NULL, after_gap INTEGER NOT NULL)",
    "CREATE TABLE action(input INTEGER PRIMARY KEY, time_ns INTEGER NOT NULL, verb TEXT NOT NULL, "
    "arguments TEXT NOT NULL)",
    "CREATE TABLE applied(input INTEGER PRIMARY KEY, step INTEGER NOT NULL)",
    "CREATE TABLE receipt(device INTEGER PRIMARY KEY, expected INTEGER NOT NULL, received INTEGER NOT NULL, "
    "dropped INTEGER NOT NULL)",
    "CREATE TABLE calibration(number INTEGER PRIMARY KEY, name TEXT NOT NULL, toml TEXT NOT NULL)",
    "CREATE TABLE snapshot(step INTEGER PRIMARY KEY, state BLOB NOT NULL)",
};

}  // namespace fude::session_schema
