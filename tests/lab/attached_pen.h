// Plugs a device in and waits until fude's own search has found its pen.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <stdexcept>

#include "drivers/transport/evdev_devices.h"
#include "tests/lab/patience.h"

namespace fude::lab {

// `plug` makes the device; the pen tablet that appears then is it. Throws when none does within patience().
inline FoundDevice attached_pen(const std::function<void()>& plug) {
  auto monitor = PlugMonitor::open();
  if (!monitor) throw std::runtime_error(monitor.error().message);
  plug();
  const Timestamp deadline = patience();
  while (auto event = (*monitor)->next(deadline))
    if (event->device) return *event->device;
  throw std::runtime_error("no pen tablet appeared");
}

}  // namespace fude::lab
