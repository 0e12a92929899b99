// How a test gets a device back that was pulled out: by its identity, under whatever node.
#pragma once

#include <chrono>
#include <string>

#include "drivers/transport/device_nodes.h"
#include "drivers/transport/returning_source.h"

namespace fude::lab {

// `open` makes a source of a node's path.
template <class OpenNode>
ReturningSource returning(NodeKind kind, const std::string& id, OpenNode open) {
  constexpr auto pause = std::chrono::milliseconds(50);
  return ReturningSource(
      [=]() -> Result<std::unique_ptr<ByteSource>> {
        const auto nodes = find_nodes(kind);
        if (!nodes) return tl::unexpected(nodes.error());
        for (const DeviceNode& node : *nodes)
          if (node.description.id == id) return open(node.path);
        return failure(Fault::not_found, id + " is away");
      },
      pause);
}

}  // namespace fude::lab
