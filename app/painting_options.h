// The options that say what to paint with and on: shared by replay, demo and paint.
#pragma once

#include <optional>
#include <string>

#include "rig/replay.h"
#include "signal/result.h"

namespace CLI {
class App;
}

namespace fude {

struct PaintingOptions {
  std::string brush = "round-goat";
  std::string paper = "xuan";
  std::string size_mm;
  std::string tablet_mm;
  double cell_mm = 0.1;
  std::string ink = "normal";
  std::string flow = "on";
  std::string settle = "0";
  std::string backend = "cpu";
  std::string isa = "auto";
  int threads = 0;  // 0: as many as there are processors

  void add_to(CLI::App& command);

  // Reads the brush and the paper and checks every value.
  // Errors: usage, not_found, malformed.
  Result<ReplaySettings> settings() const;
};

// "WxH" in millimetres. Errors: usage, naming the option.
Result<Extent> parse_extent(const std::string& text, const std::string& option);

}  // namespace fude
