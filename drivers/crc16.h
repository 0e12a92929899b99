// CRC-16/CCITT-FALSE: polynomial 0x1021 from 0xffff, high bit first; 0x29b1 of "123456789".
#pragma once

#include <cstdint>

#include "drivers/byte_order.h"

namespace fude {

inline std::uint16_t crc16(Bytes bytes) {
  unsigned crc = 0xffff;
  for (std::byte byte : bytes) {
    crc ^= std::to_integer<unsigned>(byte) << 8;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x8000 ? crc << 1 ^ 0x1021 : crc << 1) & 0xffff;
  }
  return static_cast<std::uint16_t>(crc);
}

// Whether the last two bytes are the checksum, little-endian, of those before them.
inline bool crc16_holds(Bytes bytes) {
  return bytes.size() >= 2 &&
         crc16(bytes.first(bytes.size() - 2)) == little_endian<std::uint16_t>(bytes, bytes.size() - 2);
}

inline void put_crc16(std::vector<std::byte>& bytes) { put_little_endian(bytes, crc16(bytes)); }

}  // namespace fude
