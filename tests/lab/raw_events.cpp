#include "tests/lab/raw_events.h"

#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>

#include <cerrno>
#include <ctime>
#include <system_error>

namespace fude::lab {

RawEvents::RawEvents(const std::filesystem::path& node)
    : file_(open(node.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
  int clock = CLOCK_MONOTONIC;
  if (file_.get() < 0 || ioctl(file_.get(), EVIOCSCLOCKID, &clock) != 0)
    throw std::system_error(errno, std::generic_category(), node.string());
}

std::vector<RawFrame> RawEvents::take() {
  std::vector<RawFrame> frames;
  input_event event{};
  while (read(file_.get(), &event, sizeof event) == static_cast<ssize_t>(sizeof event)) {
    open_.events.push_back({event.type, event.code, event.value});
    if (event.type != EV_SYN || event.code != SYN_REPORT) continue;
    open_.time = Timestamp(std::chrono::seconds(event.input_event_sec) +
                           std::chrono::microseconds(event.input_event_usec));
    frames.push_back(open_);
    open_ = {};
  }
  return frames;
}

}  // namespace fude::lab
