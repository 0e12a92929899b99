// Plugs a device in and waits until fude's own search has found its node.
#pragma once

#include <chrono>
#include <functional>
#include <stdexcept>

#include "drivers/transport/device_nodes.h"
#include "tests/lab/patience.h"

namespace fude::lab {

// `plug` makes the device; the node of this kind with this identity that appears then is it. Throws when
// none does within patience().
inline DeviceNode attached_node(NodeKind kind, const std::string& id, const std::function<void()>& plug) {
  auto monitor = NodeMonitor::open({&kind, 1});
  if (!monitor) throw std::runtime_error(monitor.error().message);
  plug();
  const Timestamp deadline = patience();
  while (const auto event = (*monitor)->next(deadline))
    if (event->plugged && event->node.description.id == id) return event->node;
  throw std::runtime_error("no " + id + " appeared");
}

}  // namespace fude::lab
