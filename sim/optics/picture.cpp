#include "sim/optics/picture.h"

#include <nettle/sha2.h>

namespace fude {

std::string picture_sha256(const Picture& picture) {
  sha256_ctx state;
  sha256_init(&state);
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(picture.width) * 6);
  for (int y = 0; y < picture.height; ++y) {
    std::size_t at = 0;
    for (const Rgb16& pixel : picture.row(y))
      for (const std::uint16_t value : pixel) {
        bytes[at++] = static_cast<std::uint8_t>(value >> 8);
        bytes[at++] = static_cast<std::uint8_t>(value & 0xff);
      }
    sha256_update(&state, bytes.size(), bytes.data());
  }
  std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest{};
  sha256_digest(&state, digest.size(), digest.data());
  std::string hex;
  for (const std::uint8_t byte : digest) {
    hex += "0123456789abcdef"[byte >> 4];
    hex += "0123456789abcdef"[byte & 15];
  }
  return hex;
}

}  // namespace fude
