// Which family's driver a device belongs to, and its decoder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/decoder.h"
#include "signal/device.h"

namespace fude {

enum class Family : std::uint8_t {
  tablet,
  touch,
  joycon,
  spacemouse,
  p5glove,
  handle,
  polhemus,
  ultrasonic,
  openigtlink,
  vrpn,
  camera,
  falcon,
};

// The top-level collection of a HID interface.
struct HidUsage {
  std::uint16_t page = 0;
  std::uint16_t usage = 0;
  bool operator==(const HidUsage&) const = default;
};

// One model. Without a vendor it has no identity on the wire and is named by its word (a serial line, a
// network peer), or is known by what it senses (tablet, touch).
struct FamilyRow {
  Family family;
  const char* word;  // "joycon": what a person writes to name a driver
  DeviceKind kind;
  const char* transport;  // as in DeviceDescription
  std::uint16_t vendor;
  std::uint16_t product;
  std::optional<HidUsage> usage;  // of the interface that is read, where the device has others
  const char* model;
};

std::span<const FamilyRow> family_rows();

// By transport and identity, by axes and keys for evdev, or by the name that name_at() gave; null where no
// driver here knows it. An unknown usage counts as the right one.
const FamilyRow* find_family(const DeviceDescription& device, std::optional<HidUsage> usage = std::nullopt);

// What a device without an identity is called: "VRPN at localhost:3883". A recording of it is known by this.
std::string name_at(const FamilyRow& row, std::string_view where);

// The first row of this word and transport; null where there is none.
const FamilyRow* find_family(std::string_view word, std::string_view transport);

// The description matters for evdev alone, where the axes stand in it; the firmware, a file of the user's,
// for a Falcon alone.
std::unique_ptr<Decoder> open_decoder(const FamilyRow& row, const DeviceDescription& device,
                                      std::vector<std::byte> firmware = {});

}  // namespace fude
