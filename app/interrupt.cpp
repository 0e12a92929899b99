#include "app/interrupt.h"

#include <cerrno>
#include <csignal>
#include <ctime>

namespace fude {
namespace {

sigset_t interrupts() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

}  // namespace

InterruptWatch::InterruptWatch() {
  const sigset_t set = interrupts();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

InterruptWatch::~InterruptWatch() {
  const sigset_t set = interrupts();
  // Ctrl-C pressed twice, or sent to the group and to the program: the closing goes on.
  constexpr timespec at_once{};
  while (sigtimedwait(&set, nullptr, &at_once) > 0) continue;
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

bool InterruptWatch::wait(std::optional<Duration> duration) {
  const sigset_t set = interrupts();
  if (!duration) {
    int number = 0;
    return sigwait(&set, &number) == 0;
  }
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(*duration);
  const timespec time{whole.count(), static_cast<long>((*duration - whole).count())};
  return sigtimedwait(&set, nullptr, &time) > 0;
}

}  // namespace fude
