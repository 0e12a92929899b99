// Where the real recordings lie: FUDE_RECORDINGS, else beside the project.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace fude {

inline std::filesystem::path recordings() {
  const char* given = std::getenv("FUDE_RECORDINGS");
  return given != nullptr && *given != '\0' ? given : FUDE_DEFAULT_RECORDINGS;
}

}  // namespace fude

// First line of a test that needs the recording `file`.
#define REQUIRE_RECORDING(file)                              \
  if (!std::filesystem::exists(fude::recordings() / (file))) \
  GTEST_SKIP() << "skipped: no " << (fude::recordings() / (file)) << "; set FUDE_RECORDINGS to the recordings"
