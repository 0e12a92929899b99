// Raw pen reports: golden bytes of each layout, and bytes of any kind.
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <cmath>
#include <numbers>
#include <random>

#include "drivers/tablet/hid_pen_decoder.h"
#include "drivers/tablet/hid_pen_uclogic.h"
#include "tests/fakes/family_streams.h"

namespace fude {
namespace {

Transfer report(std::initializer_list<unsigned> bytes, int ms = 0) {
  return {Timestamp(std::chrono::milliseconds(ms)), StampedBy::recording, Direction::from_device,
          TransferKind::hid_report, octets(bytes)};
}

DeviceDescription device(std::uint16_t vendor, std::uint16_t product) {
  DeviceDescription d;
  d.vendor = vendor;
  d.product = product;
  d.transport = "hidraw";
  return d;
}

class HidPen : public testing::Test {
 protected:
  void open(const DeviceDescription& d, const Transfer& first) {
    const auto described = described_hid_pen(d, {&first, 1});
    ASSERT_TRUE(described.has_value());
    tablet_ = *described;
    decoder_.emplace(tablet_);
  }
  std::optional<PenSample> read(const Transfer& transfer) {
    Decoded out;
    decoder_->decode(transfer, out);
    return out.samples.empty() ? std::nullopt : std::optional(std::get<PenSample>(out.samples.at(0)));
  }
  DeviceDescription tablet_;
  std::optional<HidPenDecoder> decoder_;
};

TEST_F(HidPen, AnIntuosTellsItsToolThenWhereItIs) {
  const Transfer enter = report({2, 0xc2, 0x80, 0x22, 0x48, 0x10, 0xf7, 0x31, 0, 0});
  const Transfer down = report({2, 0xe1, 0x6a, 0xf7, 0x38, 0x9d, 0x90, 0x1b, 0x55, 0x61}, 8);
  open(device(0x056a, 0xfa), down);
  EXPECT_NEAR(tablet_.width->value, 477.2, 1e-9);
  EXPECT_FALSE(read(enter).has_value());
  const auto pen = read(down);
  ASSERT_TRUE(pen.has_value());
  EXPECT_EQ(pen->tool, PenTool::pen);
  EXPECT_EQ(pen->tool_id, 0x100802U);
  EXPECT_EQ(pen->tool_serial, 0x24810f73U);
  EXPECT_EQ(pen->x_counts, 0x6af7 * 2 + 0);
  EXPECT_EQ(pen->y_counts, 0x389d * 2 + 1);
  EXPECT_EQ(pen->pressure_raw, 0x90 << 3 | (0x1b & 0xc0) >> 5 | 1);
  EXPECT_TRUE(pen->in_contact);
  EXPECT_NEAR(in_degrees(*pen->tilt_x), ((0x1b << 1 & 0x7e) | 0) - 64, 1e-9);
  EXPECT_NEAR(in_degrees(*pen->tilt_y), 0x55 - 64, 1e-9);
  EXPECT_EQ(pen->distance, Fraction(24.0 / 63));
  EXPECT_EQ(pen->time.host, down.time);
  const auto gone = read(report({2, 0x80, 0, 0, 0, 0, 0, 0, 0, 0}, 16));
  ASSERT_TRUE(gone.has_value());
  EXPECT_EQ(gone->tool, PenTool::none);
  EXPECT_FALSE(gone->in_proximity || gone->in_contact);
  EXPECT_EQ(gone->x_counts, pen->x_counts);
  EXPECT_FALSE(read(report({0x0c, 0, 0, 0, 0, 0, 0, 0, 0, 0})).has_value());  // the pad
  EXPECT_FALSE(read(report({2, 0xe1, 0, 0})).has_value());                    // cut short
  EXPECT_EQ(decoder_->counts().unknown, 1U);
  EXPECT_EQ(decoder_->counts().malformed, 1U);
}

TEST_F(HidPen, TheOtherEndAndTheBarrelOfAnArtPen) {
  const Transfer first = report({2, 0xe0, 0, 1, 0, 1, 0, 0, 0, 0});
  open(device(0x056a, 0x314), first);
  (void)read(report({2, 0xc2, 0x80, 0xa2, 0x48, 0x10, 0xf7, 0x31, 0, 0}));  // 0x10080a
  EXPECT_EQ(read(first)->tool, PenTool::rubber);
  (void)read(report({2, 0xc2, 0x80, 0x42, 0x48, 0x10, 0xf7, 0x31, 0, 0}));  // 0x100804
  // 450 - 600/2 = 150 of 1800 to the turn: 30 degrees.
  const auto turned = read(report({2, 0xea, 0, 1, 0, 1, 600 >> 3, (600 & 6) << 5, 0, 0}));
  ASSERT_TRUE(turned.has_value());
  EXPECT_NEAR(turned->rotation->value, std::numbers::pi / 6, 1e-12);
  // A puck is no pen.
  (void)read(report({2, 0xc2, 0x80, 0x62, 0x48, 0x10, 0xf7, 0x30, 0, 0}));  // 0x806
  EXPECT_FALSE(read(first).has_value());
}

TEST_F(HidPen, AGraphireHasEightBytes) {
  const Transfer down = report({2, 0x93, 0x12, 0x10, 0x34, 0x12, 0x45, 0x01});
  open(device(0x056a, 0x13), down);
  EXPECT_NEAR(tablet_.width->value, 127.6, 1e-9);
  const auto pen = read(down);
  ASSERT_TRUE(pen.has_value());
  EXPECT_EQ(pen->x_counts, 0x1012);
  EXPECT_EQ(pen->y_counts, 0x1234);
  EXPECT_EQ(pen->pressure_raw, 0x145);
  EXPECT_NEAR(pen->pressure.value, 0x145 / 511.0, 1e-15);
  EXPECT_TRUE(pen->in_contact);
  EXPECT_EQ(pen->buttons, 1U);
  EXPECT_EQ(read(report({2, 0xb0, 0, 0, 0, 0, 0, 0}))->tool, PenTool::rubber);
  EXPECT_FALSE(read(report({2, 0xd0, 0, 0, 0, 0, 0, 0})).has_value());  // its mouse
  EXPECT_EQ(read(report({2, 0x10, 0, 0, 0, 0, 0, 0}))->tool, PenTool::none);
}

TEST_F(HidPen, UcLogicsReportsTellTheirOwnLayout) {
  const Transfer down = report({8, 0x83, 0x70, 0xc6, 0x06, 0x7c, 0xff, 0x1f, 1, 0, 0xc4, 0x3c});
  open(device(0x256c, 0x6d), down);
  EXPECT_NEAR(tablet_.mm_per_count.value(), 0.005, 1e-15);
  const auto pen = read(down);
  ASSERT_TRUE(pen.has_value());
  EXPECT_EQ(pen->x_counts, 0x1c670);
  EXPECT_EQ(pen->y_counts, 31750);
  EXPECT_EQ(pen->pressure, Fraction(1));
  EXPECT_NEAR(in_degrees(*pen->tilt_x), -60, 1e-12);
  EXPECT_NEAR(in_degrees(*pen->tilt_y), -60, 1e-12);
  EXPECT_EQ(pen->buttons, 1U);
  EXPECT_EQ(read(report({8, 0x00, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}))->tool, PenTool::none);
  EXPECT_FALSE(read(report({8, 0xf0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0})).has_value());  // a dial
  EXPECT_FALSE(read(report({0x78, 0xcc, 0, 8, 0x78, 0xcc, 0, 8, 0x78, 0xcc, 0, 8})).has_value());
  EXPECT_EQ(decoder_->counts().unknown, 1U);
  EXPECT_EQ(decoder_->counts().malformed, 1U);

  const Transfer small = report({9, 0xc1, 0x41, 0x3d, 0xda, 0x12, 0xff, 0x03});
  open(device(0x5543, 0x522), small);
  EXPECT_EQ(read(small)->x_counts, 0x3d41);
  EXPECT_EQ(read(small)->pressure, Fraction(1));
  EXPECT_FALSE(read(small)->tilt_x.has_value());
  EXPECT_EQ(read(report({9, 0x80, 0x41, 0x3d, 0xda, 0x12, 0, 0}))->tool, PenTool::none);
}

// Tip, barrel, eraser, invert and in range; x and y; pressure; tilt.
DeviceDescription standard_tablet() {
  DeviceDescription d = device(0x28bd, 0x904);
  d.hid_descriptor = standard_pen_descriptor();
  return d;
}

TEST_F(HidPen, AStandardPenIsReadByItsDescriptor) {
  const Transfer down = report({7, 0x13, 0x88, 0x13, 0x10, 0x27, 0xff, 0x1f, 0x1e, 0xe2});
  open(standard_tablet(), down);
  EXPECT_NEAR(tablet_.width->value, 100, 1e-9);  // 1000 of a hundredth of a centimetre
  ASSERT_EQ(tablet_.axes.size(), 3U);
  EXPECT_EQ(tablet_.axes[2].maximum, 8191);
  const auto pen = read(down);
  ASSERT_TRUE(pen.has_value());
  EXPECT_EQ(pen->x_counts, 5000);
  EXPECT_EQ(pen->y_counts, 10000);
  EXPECT_EQ(pen->pressure, Fraction(1));
  EXPECT_TRUE(pen->in_contact);
  EXPECT_EQ(pen->buttons, 1U);
  EXPECT_NEAR(in_degrees(*pen->tilt_x), 30, 1e-12);
  EXPECT_NEAR(in_degrees(*pen->tilt_y), -30, 1e-12);
  EXPECT_EQ(read(report({7, 0x18, 0, 0, 0, 0, 0, 0, 0, 0}))->tool, PenTool::rubber);  // turned round, near
  EXPECT_EQ(read(report({7, 0x00, 0, 0, 0, 0, 0, 0, 0, 0}))->tool, PenTool::none);
}

// Without its pressure a pen that touches would be one pressed to the full.
TEST_F(HidPen, AStandardReportCutShortIsNoSample) {
  const Transfer down = report({7, 0x13, 0x88, 0x13, 0x10, 0x27, 0xff, 0x1f, 0x1e, 0xe2});
  open(standard_tablet(), down);
  for (std::size_t kept = 0; kept < down.payload.size(); ++kept) {
    Transfer cut = down;
    cut.payload.resize(kept);
    EXPECT_FALSE(read(cut).has_value()) << kept;
    EXPECT_EQ(decoder_->counts().malformed, kept + 1);
  }
  Transfer longer = down;  // some devices fill their reports up
  longer.payload.resize(64);
  EXPECT_EQ(read(longer)->pressure, Fraction(1));
}

// Each report of a descriptor is a layout of its own, however they are interleaved in it.
TEST_F(HidPen, TwoPensOfOneDescriptor) {
  const auto position = [](unsigned number) {
    return octets({0x85, number, 0x05, 0x01, 0x09, 0x30, 0x09, 0x31, 0x75, 0x08, 0x95, 0x02, 0x81, 0x02});
  };
  const auto tip = [](unsigned number) {
    return octets({0x85, number, 0x05, 0x0d, 0x09, 0x42, 0x75, 0x08, 0x95, 0x01, 0x81, 0x02});
  };
  DeviceDescription d = device(0x28bd, 0x904);
  d.hid_descriptor = octets({0x05, 0x0d, 0x09, 0x02, 0xa1, 0x01, 0x15, 0x00, 0x25, 0x7f});
  for (const auto& part : {position(9), position(4), tip(4), tip(9), octets({0xc0})})
    d.hid_descriptor.insert(d.hid_descriptor.end(), part.begin(), part.end());
  open(d, report({4, 1, 2, 0}));
  const auto fourth = read(report({4, 10, 20, 1}));
  const auto ninth = read(report({9, 30, 40, 0}));
  ASSERT_TRUE(fourth && ninth);
  EXPECT_TRUE(fourth->in_contact);
  EXPECT_EQ(fourth->x_counts, 10);
  EXPECT_FALSE(ninth->in_contact);
  EXPECT_EQ(ninth->y_counts, 40);
  EXPECT_FALSE(read(report({5, 30, 40, 0})).has_value());
  EXPECT_EQ(decoder_->counts().unknown, 1U);
}

TEST_F(HidPen, BytesOfAnyKindAreSafe) {
  std::mt19937 random(3);
  for (const auto& [vendor, product] : {std::pair{0x056a, 0xfa}, {0x056a, 0x13}, {0x256c, 0x6d}, {0, 0}}) {
    HidPenDecoder decoder(device(static_cast<std::uint16_t>(vendor), static_cast<std::uint16_t>(product)));
    std::uint64_t sent = 0;
    for (int i = 0; i < 20000; ++i) {
      Transfer transfer = report({});
      transfer.payload.resize(random() % 14);
      for (std::byte& b : transfer.payload) b = static_cast<std::byte>(random());
      if (!transfer.payload.empty() && random() % 2)
        transfer.payload[0] = static_cast<std::byte>(std::array{2, 8, 9, 12}[random() % 4]);
      Decoded out;
      decoder.decode(transfer, out);
      ++sent;
      for (const Sample& s : out.samples) {
        const auto& pen = std::get<PenSample>(s);
        EXPECT_TRUE(pen.pressure.value >= 0 && pen.pressure.value <= 1);
        EXPECT_EQ(pen.in_proximity, pen.tool != PenTool::none);
        EXPECT_TRUE(pen.in_proximity || !pen.in_contact);
      }
    }
    const ReportCounts& counts = decoder.counts();
    EXPECT_EQ(counts.reports + counts.malformed + counts.unknown, sent);
  }
}

TEST(HidPenDescription, OnlyPensThatAreKnownAreTakenForPens) {
  const Transfer touch = report({1, 2, 3});
  EXPECT_FALSE(described_hid_pen(device(0x056a, 0x314), {&touch, 1}).has_value());
  EXPECT_FALSE(described_hid_pen(device(0x2833, 1), {&touch, 1}).has_value());
  EXPECT_FALSE(described_hid_pen(device(0, 0), {}).has_value());
}

}  // namespace
}  // namespace fude
