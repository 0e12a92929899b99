// Transfers written as a person writes them: kind, hexadecimal bytes, milliseconds.
#pragma once

#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/decoder.h"
#include "signal/transfer.h"

namespace fude {

// Every two hexadecimal digits are one byte; anything else between them is for the eye.
inline std::vector<std::byte> from_hex(std::string_view text) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return -1;
  };
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    if (digit(text[i]) < 0) continue;
    bytes.push_back(static_cast<std::byte>(digit(text[i]) << 4 | digit(text[i + 1])));
    ++i;
  }
  return bytes;
}

inline Transfer from_device(TransferKind kind, std::vector<std::byte> payload = {}, int milliseconds = 0) {
  Transfer transfer;
  transfer.time = Timestamp(std::chrono::milliseconds(milliseconds));
  transfer.stamped_by = StampedBy::arrival;
  transfer.kind = kind;
  transfer.payload = std::move(payload);
  return transfer;
}

inline Decoded decoded(Decoder& decoder, const Transfer& transfer) {
  Decoded out;
  decoder.decode(transfer, out);
  return out;
}

}  // namespace fude
