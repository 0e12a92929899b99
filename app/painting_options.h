// The options that say what to paint with and on: shared by replay, demo and paint.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "rig/replay.h"
#include "signal/result.h"

namespace CLI {
class App;
}

namespace fude {

// How a painting stood when it was recorded: the settings of a session. `brush`, `paper` and `palette` are
// TOML text, `sheet_mm` and `cell_mm` millimetres, `ink`, `flow` and `manner` as the options of those names.
using RecordedSettings = std::map<std::string, std::string>;

// What is not given is as the session has it; else a round goat brush and ink on Xuan paper of 0.1 mm cells.
struct PaintingOptions {
  std::string brush;
  std::string palette;
  std::string manner;
  std::string paper;
  std::string size_mm;
  std::string tablet_mm;
  std::vector<std::string> calibrations;
  std::string cell_mm;
  std::string ink;
  std::string flow;
  std::string settle = "0";
  std::string backend = "cpu";
  std::string isa = "auto";
  int threads = 0;  // 0: as many as there are processors

  void add_to(CLI::App& command);

  // Reads the brush and the paper and checks every value.
  // Errors: usage, not_found, malformed.
  Result<ReplaySettings> settings(const RecordedSettings& recorded = {}) const;
};

// "WxH" in millimetres. Errors: usage, naming the option.
Result<Extent> parse_extent(const std::string& text, const std::string& option);

// The same the other way, exactly.
std::string as_text(Extent extent);

}  // namespace fude
