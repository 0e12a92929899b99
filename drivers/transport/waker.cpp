#include "drivers/transport/waker.h"

#include <poll.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <ctime>
#include <system_error>

namespace fude {

Timestamp monotonic_now() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return Timestamp(std::chrono::seconds(now.tv_sec) + Duration(now.tv_nsec));
}

Waker::Waker() : event_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (event_.get() < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

void Waker::wake() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = write(event_.get(), &one, sizeof one);
}

Waker::Outcome Waker::wait(int device, std::optional<Timestamp> deadline) {
  std::array<pollfd, 2> waiting{{{device, POLLIN, 0}, {event_.get(), POLLIN, 0}}};
  timespec left{};
  if (deadline) {
    const Duration until = std::max(*deadline - monotonic_now(), Duration(0));
    const auto whole = std::chrono::duration_cast<std::chrono::seconds>(until);
    left = {static_cast<time_t>(whole.count()), static_cast<long>((until - whole).count())};
  }
  if (ppoll(waiting.data(), waiting.size(), deadline ? &left : nullptr, nullptr) <= 0) return {};
  Outcome outcome;
  if (waiting[1].revents & POLLIN) {
    std::uint64_t count = 0;
    outcome.woken = read(event_.get(), &count, sizeof count) > 0;
  }
  outcome.ready = (waiting[0].revents & POLLIN) != 0;
  outcome.gone = (waiting[0].revents & (POLLHUP | POLLERR | POLLNVAL)) != 0;
  return outcome;
}

}  // namespace fude
