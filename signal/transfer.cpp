#include "signal/transfer.h"

namespace fude {
namespace {

constexpr std::size_t event_size = 8;

}  // namespace

std::vector<std::byte> pack_events(std::span<const EvdevEvent> events) {
  std::vector<std::byte> bytes;
  bytes.reserve(events.size() * event_size);
  const auto put = [&bytes](std::uint32_t value, int width) {
    for (int i = 0; i < width; ++i) bytes.push_back(static_cast<std::byte>(value >> (8 * i)));
  };
  for (const EvdevEvent& e : events) {
    put(e.type, 2);
    put(e.code, 2);
    put(static_cast<std::uint32_t>(e.value), 4);
  }
  return bytes;
}

Result<std::vector<EvdevEvent>> unpack_events(std::span<const std::byte> payload) {
  if (payload.size() % event_size != 0)
    return failure(Fault::malformed, "an event frame of " + std::to_string(payload.size()) +
                                         " bytes is cut short: each event takes 8");
  std::vector<EvdevEvent> events;
  events.reserve(payload.size() / event_size);
  const auto get = [&payload](std::size_t at, int width) {
    std::uint32_t value = 0;
    for (int i = 0; i < width; ++i)
      value |= std::to_integer<std::uint32_t>(payload[at + static_cast<std::size_t>(i)]) << (8 * i);
    return value;
  };
  for (std::size_t at = 0; at < payload.size(); at += event_size)
    events.push_back({static_cast<std::uint16_t>(get(at, 2)), static_cast<std::uint16_t>(get(at + 2, 2)),
                      static_cast<std::int32_t>(get(at + 4, 4))});
  return events;
}

}  // namespace fude
