// Every kind of sample as a table: its columns once, as data, from which the session's SQL, its reading and
// writing, and the exported CSV come.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "signal/sample.h"

namespace fude {

// What stands in one column of one row; nothing where an optional value is not there.
using Cell = std::variant<std::monostate, std::int64_t, double, std::string>;

enum class CellType : std::uint8_t { integer, real, text };

struct SampleColumn {
  std::string name;  // ends in its unit where it has one: turn_x_radps
  std::string unit;  // "rad/s"; empty where a number has none or words stand
  CellType type = CellType::integer;
  bool optional = false;
  std::function<Cell(const Sample&)> get;
  // False for a cell that the value cannot hold: another type, a number out of range, an unknown word.
  std::function<bool(Sample&, const Cell&)> set;
  int since_format = 1;  // of the session file; an older one has no such column
};

struct SampleTable {
  std::string name;                   // of the SQL table: "imu_sample"
  std::string stream;                 // what a stream of it is called: "imu"
  Sample blank;                       // of this kind, to be filled
  std::vector<SampleColumn> columns;  // the first four are the time's
};

// One for each kind, in the order of Sample's alternatives: sample_tables()[sample.index()] is the sample's.
std::span<const SampleTable> sample_tables();

// The time of any sample, whether the device vouches for it, and whether something was lost before it.
const SampleTime& time_of(const Sample& sample);
bool valid(const Sample& sample);
bool after_gap(const Sample& sample);

// A tracker's streams are told apart by tool or marker; empty for other kinds.
std::string part_of(const Sample& sample);

}  // namespace fude
