// Where the real recordings lie: FUDE_RECORDINGS, else beside the project.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

namespace fude {

std::filesystem::path recordings();

}  // namespace fude

// First line of a test that needs the recording `file`.
#define REQUIRE_RECORDING(file)                              \
  if (!std::filesystem::exists(fude::recordings() / (file))) \
  GTEST_SKIP() << "skipped: no " << (fude::recordings() / (file)) << "; set FUDE_RECORDINGS to the recordings"
