// The tables of a session file. docs/session-format.md explains every column.
#pragma once

#include <string>
#include <vector>

#include "capture/sample_columns.h"

namespace fude::session_schema {

inline constexpr int application_id = 0x66756465;  // "fude"
inline constexpr int oldest_format = 1;            // pens alone; still read
inline constexpr int format = 4;

// As `CREATE TABLE` statements, which is how the file itself keeps them.
std::vector<std::string> tables(int of_format);

// The table of one kind of sample: `input`, `device`, then the columns of its kind.
std::string create(const SampleTable& table, int of_format = format);
std::string insert(const SampleTable& table);

}  // namespace fude::session_schema
