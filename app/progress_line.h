// Progress of long work: a line on a terminal, nothing in a pipe.
#pragma once

#include <cstdint>
#include <string>

namespace fude {

class ProgressLine {
 public:
  explicit ProgressLine(std::string what);
  ~ProgressLine();
  void show(double share) const;                           // 0 to 1
  void show(double share, const std::string& next) const;  // what is to be done next; may be empty
  void show(std::uint64_t count, const char* of) const;

 private:
  std::string what_;
  bool on_terminal_;
};

}  // namespace fude
