// How often each device is pulled out and put back, and when; a thousand by hand with FUDE_LAB_REPLUGS.
#pragma once

#include <chrono>
#include <cstdlib>
#include <random>
#include <thread>

namespace fude::lab {

inline int replugs() {
  const char* given = std::getenv("FUDE_LAB_REPLUGS");
  const int count = given != nullptr ? std::atoi(given) : 0;
  return count > 0 ? count : 20;
}

// Waits so that each life ends at another moment of what is under way, which takes `period`.
inline void wait_for_any_moment(int life, std::chrono::microseconds period) {
  std::mt19937 random(static_cast<unsigned>(life));
  std::this_thread::sleep_for(std::chrono::microseconds(random() % period.count()));
}

}  // namespace fude::lab
