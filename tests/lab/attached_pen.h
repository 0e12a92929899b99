// Plugs a device in and waits until fude's own search has found its pen.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <stdexcept>

#include "drivers/transport/device_nodes.h"
#include "tests/lab/patience.h"

namespace fude::lab {

// `plug` makes the device; the pen tablet that appears then is it. Throws when none does within patience().
inline DeviceNode attached_pen(const std::function<void()>& plug) {
  constexpr NodeKind kind = NodeKind::input;
  auto monitor = NodeMonitor::open({&kind, 1});
  if (!monitor) throw std::runtime_error(monitor.error().message);
  plug();
  const Timestamp deadline = patience();
  while (auto event = (*monitor)->next(deadline))
    if (event->plugged) return event->node;
  throw std::runtime_error("no pen tablet appeared");
}

}  // namespace fude::lab
