#include "tests/fakes/recordings.h"

#include <cstdlib>

namespace fude {

std::filesystem::path recordings() {
  const char* given = std::getenv("FUDE_RECORDINGS");
  return given != nullptr && *given != '\0' ? given : FUDE_DEFAULT_RECORDINGS;
}

}  // namespace fude
