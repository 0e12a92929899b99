#include "app/progress_line.h"

#include <unistd.h>

#include <cstdio>
#include <utility>

namespace fude {

ProgressLine::ProgressLine(std::string what)
    : what_(std::move(what)), on_terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (on_terminal_) std::fprintf(stderr, "\r\033[K");
}

void ProgressLine::show(double share) const {
  if (on_terminal_) std::fprintf(stderr, "\r%s %3.0f %%", what_.c_str(), 100 * share);
}

void ProgressLine::show(double share, const std::string& next) const {
  if (on_terminal_)
    std::fprintf(stderr, "\r\033[K%s %3.0f %%%s%s", what_.c_str(), 100 * share, next.empty() ? "" : ": ",
                 next.c_str());
}

void ProgressLine::show(std::uint64_t count, const char* of) const {
  if (on_terminal_)
    std::fprintf(stderr, "\r%s %llu %s", what_.c_str(), static_cast<unsigned long long>(count), of);
}

}  // namespace fude
