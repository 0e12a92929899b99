// A painted sheet from anyone: whatever is taken for one is written again as the same bytes.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "rig/sheet_snapshot.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  const auto sheet = fude::sheet_from_bytes(bytes);
  if (!sheet) return 0;
  const std::vector<std::byte> again = fude::as_bytes(*sheet);
  if (!std::equal(bytes.begin(), bytes.end(), again.begin(), again.end())) std::abort();
  return 0;
}
