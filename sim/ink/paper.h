// What paper and ink are made of: one value, read from TOML, its parameters named in paper_parameters.inl.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "signal/result.h"

namespace fude {

struct PaperSpec {
  std::string name = "xuan";
#define PARAMETER(id, unit, low, high, standard, meaning) double id = standard;
#include "sim/ink/paper_parameters.inl"
#undef PARAMETER
};

// One row of the table, for readers, panels and the manual.
struct PaperParameter {
  std::string_view id;
  std::string_view unit;
  double low;
  double high;
  double standard;
  std::string_view meaning;
  double PaperSpec::*value;
};
std::span<const PaperParameter> paper_parameters();

// Reads `name` and the [ink] table of TOML text; other tables belong to others. Fault::malformed where the
// TOML is broken, a key is not in the table or a value is out of its range; `source` is named in the message.
Result<PaperSpec> read_paper(std::string_view toml, const std::string& source);

// The same from a file. Fault::not_found where there is none.
Result<PaperSpec> load_paper(const std::filesystem::path& file);

}  // namespace fude
