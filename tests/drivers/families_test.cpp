#include "drivers/families.h"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <map>
#include <random>
#include <set>
#include <string>

#include "tests/fakes/sound_sample.h"
#include "tests/fakes/transfers.h"

namespace fude {
namespace {

DeviceDescription described(const FamilyRow& row) {
  DeviceDescription device;
  device.transport = row.transport;
  device.vendor = row.vendor;
  device.product = row.product;
  if (row.family == Family::tablet) {
    device.keys = {BTN_TOOL_PEN, BTN_TOUCH};
    device.axes = {{.code = ABS_X, .maximum = 1000}, {.code = ABS_Y, .maximum = 1000}};
  }
  if (row.family == Family::touch)
    device.axes = {{.code = ABS_MT_SLOT, .maximum = 4},
                   {.code = ABS_MT_POSITION_X, .maximum = 1000},
                   {.code = ABS_MT_POSITION_Y, .maximum = 1000}};
  return device;
}

TEST(Families, NoTwoRowsClaimOneDevice) {
  const auto rows = family_rows();
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = i + 1; j < rows.size(); ++j) {
      const FamilyRow& a = rows[i];
      const FamilyRow& b = rows[j];
      const bool same_transport = std::string(a.transport) == b.transport;
      const bool same_usage = !a.usage || !b.usage || *a.usage == *b.usage;
      if (a.vendor != 0 && same_transport && a.vendor == b.vendor && a.product == b.product) {
        EXPECT_FALSE(same_usage) << a.model << " and " << b.model;
      }
      // Where there is no identity the word is one.
      if (a.vendor == 0 && b.vendor == 0 && same_transport) {
        EXPECT_STRNE(a.word, b.word);
      }
    }
}

TEST(Families, ADeviceThatAPersonNamedIsKnownByThatName) {
  for (const FamilyRow& row : family_rows()) {
    const std::string transport = row.transport;
    if (row.vendor != 0 || (transport != "serial" && transport != "network")) continue;
    DeviceDescription device;
    device.transport = transport;
    device.name = name_at(row, "somewhere:1");
    EXPECT_EQ(find_family(device), &row) << device.name;
    device.name = "a stranger at " + device.name;
    EXPECT_EQ(find_family(device), nullptr);
  }
}

TEST(Families, RowsAreWhole) {
  const std::set<std::string> transports{"evdev", "hidraw", "usb", "serial", "network", "v4l2"};
  std::map<std::string, Family> families;
  for (const FamilyRow& row : family_rows()) {
    EXPECT_TRUE(transports.contains(row.transport)) << row.model;
    EXPECT_FALSE(std::string(row.model).empty());
    EXPECT_NE(row.kind, DeviceKind::other);
    const std::string word = row.word;
    EXPECT_EQ(word.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789"), std::string::npos) << word;
    EXPECT_EQ(families.emplace(word, row.family).first->second, row.family) << word << " names two families";
    EXPECT_TRUE(!row.usage || std::string(row.transport) == "hidraw") << row.model;
  }
}

TEST(Families, EachRowIsFoundByItsOwnDevice) {
  for (const FamilyRow& row : family_rows()) {
    const bool by_itself = row.vendor != 0 || std::string(row.transport) == "evdev";
    if (by_itself) {
      EXPECT_EQ(find_family(described(row), row.usage), &row) << row.model;
    }
    EXPECT_NE(find_family(row.word, row.transport), nullptr);
    EXPECT_NE(open_decoder(row, described(row)), nullptr);
  }
}

TEST(Families, WhatNobodyKnowsIsNobodys) {
  EXPECT_EQ(find_family({.transport = "hidraw", .vendor = 0xdead, .product = 0xbeef}), nullptr);
  EXPECT_EQ(find_family({.transport = "hidraw", .vendor = 0, .product = 0}), nullptr);
  EXPECT_EQ(find_family({.transport = "usb", .vendor = 0x057e, .product = 0x2006}), nullptr);
  EXPECT_EQ(find_family({.transport = "hidraw", .vendor = 0x256f, .product = 0xc652}, HidUsage{0x01, 0x02}),
            nullptr);
  EXPECT_EQ(find_family("joycon", "serial"), nullptr);
  EXPECT_EQ(find_family({.transport = "evdev"}), nullptr);
}

// Every family, with what a hostile device or a broken wire may give it: it goes on, and whatever it makes
// of it is finite and within its range. Transfers are noise, or a greeting echoed with bytes changed.
TEST(Families, NoBytesGiveAnUnsoundSample) {
  std::mt19937 generator(20260211);
  const auto below = [&](unsigned limit) {
    return std::uniform_int_distribution<unsigned>(0, limit - 1)(generator);
  };
  constexpr TransferKind kinds[] = {
      TransferKind::hid_report, TransferKind::hid_feature, TransferKind::serial,  TransferKind::usb_bulk,
      TransferKind::message,    TransferKind::evdev_frame, TransferKind::plugged, TransferKind::unplugged,
      TransferKind::suspended,  TransferKind::usb_control, TransferKind::picture};
  constexpr unsigned first_bytes[] = {0x01, 0x02, 0x03, 0x21, 0x30, '0', 'L', 'P', 0x00, 0x06, 0x0c, 0x17};
  for (const FamilyRow& row : family_rows()) {
    const auto decoder = open_decoder(row, described(row));
    int milliseconds = 0;
    for (int i = 0; i < 3000; ++i) {
      milliseconds += static_cast<int>(below(40));
      std::vector<std::byte> payload(i % 3 == 0 ? 24 + below(50) : below(80));
      for (std::byte& byte : payload) byte = static_cast<std::byte>(below(4) == 0 ? 0 : below(256));
      if (!payload.empty()) payload[0] = static_cast<std::byte>(first_bytes[below(std::size(first_bytes))]);
      for (const Sample& sample :
           decoded(*decoder, from_device(kinds[below(std::size(kinds))], payload, milliseconds)).samples)
        EXPECT_TRUE(is_sound(sample)) << row.model;
      if (i % 500 == 0) decoder->greeting();
    }
  }
}

}  // namespace
}  // namespace fude
