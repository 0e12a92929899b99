// How often each device is pulled out and put back; a thousand by hand with FUDE_LAB_REPLUGS.
#pragma once

#include <cstdlib>

namespace fude::lab {

inline int replugs() {
  const char* given = std::getenv("FUDE_LAB_REPLUGS");
  const int count = given != nullptr ? std::atoi(given) : 0;
  return count > 0 ? count : 20;
}

}  // namespace fude::lab
