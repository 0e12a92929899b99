#include "drivers/transport/sleep_watch.h"

#include <algorithm>
#include <ctime>
#include <utility>

namespace fude {
namespace {

Duration read_clock(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::chrono::seconds(now.tv_sec) + Duration(now.tv_nsec);
}

}  // namespace

SleepWatch::SleepWatch()
    : SleepWatch([] { return read_clock(CLOCK_MONOTONIC); }, [] { return read_clock(CLOCK_BOOTTIME); }) {}

SleepWatch::SleepWatch(Clock monotonic, Clock boot)
    : monotonic_(std::move(monotonic)), boot_(std::move(boot)), most_(Duration::max()) {
  slept();
}

// What was slept in all lies between `least` and `most`, however long this thread was kept from running
// between the readings: so a busy machine is not taken for one that slept.
bool SleepWatch::slept() {
  const Duration before = monotonic_();
  const Duration boot = boot_();
  const Duration least = boot - monotonic_();
  const Duration most = boot - before;
  const bool slept = least > most_;
  most_ = slept ? most : std::min(most_, most);
  return slept;
}

}  // namespace fude
