// Bytes and transfers written short.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

#include "signal/transfer.h"

namespace fude::lab {

using Bytes = std::vector<std::byte>;

inline Bytes bytes(std::initializer_list<unsigned> values) {
  Bytes out;
  for (const unsigned value : values) out.push_back(static_cast<std::byte>(value));
  return out;
}

inline Transfer to_device(TransferKind kind, Bytes payload, std::uint8_t endpoint = 0) {
  Transfer transfer;
  transfer.direction = Direction::to_device;
  transfer.kind = kind;
  transfer.payload = std::move(payload);
  transfer.endpoint = endpoint;
  return transfer;
}

// `size` bytes, each of the count's own making, the first two the count itself.
inline Bytes numbered(unsigned count, std::size_t size) {
  Bytes out = bytes({count & 0xff, count >> 8 & 0xff});
  while (out.size() < size) out.push_back(static_cast<std::byte>(count * 7 + out.size() * 13));
  out.resize(size);
  return out;
}

}  // namespace fude::lab
