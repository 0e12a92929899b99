#include "rig/haptic_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/fakes/falcon_arm.h"

namespace fude {
namespace {

using namespace falcon;

std::vector<std::byte> image() {
  std::vector<std::byte> bytes(1000);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i * 7 + i / 256);
  return bytes;
}

// A reader over an arm whose clock runs as fast as the loop does. All that is read here after finish() was
// written on the reader's thread.
struct Reading {
  std::unique_ptr<ManualClock> own_clock = std::make_unique<ManualClock>();
  ManualClock& clock = *own_clock;
  std::unique_ptr<FalconArm> own_arm = std::make_unique<FalconArm>(clock);
  FalconArm& arm = *own_arm;
  std::vector<Transfer> transfers;
  std::vector<Sample> samples;
  std::vector<Error> refused;
  std::atomic<bool> ended{false};
  bool gone = false;
  HapticLoop::Counts counts;

  // Until this many milliseconds of the arm's time have passed.
  void run(FalconDecoder& decoder, int milliseconds, const std::function<void(FalconArm&, int)>& script) {
    int now = 0;
    clock.woke = [&, milliseconds](Timestamp) {
      script(arm, ++now);
      if (now >= milliseconds) ended = true;
    };
    HapticWish wish;
    wish.refused = [&](const Error& error) { refused.push_back(error); };
    wish.clock = std::move(own_clock);
    HapticReader reader(
        std::move(own_arm), decoder,
        [&](const Transfer& transfer, std::span<const Sample> made) {
          transfers.push_back(transfer);
          samples.insert(samples.end(), made.begin(), made.end());
        },
        std::move(wish));
    while (!ended) std::this_thread::yield();
    gone = reader.stop();
    counts = reader.counts();
  }
};

// The arm and the clock are gone with the reader; what is to be seen of them is seen in the script.
TEST(HapticReader, HearsTheWholeDialogueInItsOrder) {
  FalconDecoder decoder({}, false);
  Reading reading;
  reading.run(decoder, 2000, [](FalconArm& arm, int ms) {
    arm.state.encoders = {static_cast<std::int16_t>(ms % 300), 0, static_cast<std::int16_t>(-ms % 200)};
  });
  EXPECT_FALSE(reading.gone);
  EXPECT_GT(reading.samples.size(), 1990u);
  EXPECT_EQ(reading.counts.samples, reading.samples.size());
  EXPECT_TRUE(reading.refused.empty());
  const auto to_arm = std::ranges::count(reading.transfers, Direction::to_device, &Transfer::direction);
  EXPECT_GT(to_arm, 1990);
  EXPECT_TRUE(std::ranges::is_sorted(reading.transfers, {}, &Transfer::time));
  // What was recorded decodes to the same again.
  FalconDecoder again({}, false);
  Decoded out;
  for (const Transfer& transfer : reading.transfers) again.decode(transfer, out);
  EXPECT_EQ(out.samples.size(), reading.samples.size());
  for (std::size_t i = 0; i < std::min(out.samples.size(), reading.samples.size()); ++i)
    ASSERT_EQ(std::get<HapticSample>(out.samples[i]), std::get<HapticSample>(reading.samples[i])) << i;
}

TEST(HapticReader, WithoutAModelThereIsNoForce) {
  FalconDecoder decoder({}, false);
  Reading reading;
  bool forceless = true;
  reading.run(decoder, 500, [&](FalconArm& arm, int) {
    for (const auto& sent : arm.sent)
      forceless = forceless && sent.message.motors == std::array<std::int16_t, 3>{};
    arm.sent.clear();
  });
  EXPECT_TRUE(forceless);
  for (const Sample& sample : reading.samples) EXPECT_TRUE(std::get<HapticSample>(sample).force_n.isZero());
}

TEST(HapticReader, AnArmIsGivenItsFirmwareFirst) {
  FalconDecoder decoder(image(), false);
  Reading reading;
  reading.arm.firmware = PowerOn(image());
  reading.arm.firmware.spoil(9);
  reading.run(decoder, 5000, [](FalconArm&, int) {});
  EXPECT_EQ(decoder.state(), FalconDecoder::State::running);
  EXPECT_GT(reading.samples.size(), 1000u);
  EXPECT_TRUE(reading.refused.empty());
}

TEST(HapticReader, AnArmWithoutFirmwareSaysSoOnceAnAbsence) {
  FalconDecoder decoder({}, false);
  Reading reading;
  reading.arm.firmware = PowerOn(image());
  reading.run(decoder, 3000, [](FalconArm& arm, int ms) {
    if (ms != 1000) return;
    arm.instead.push_back({.kind = TransferKind::unplugged});
    arm.instead.push_back({.kind = TransferKind::plugged});
  });
  ASSERT_EQ(reading.refused.size(), 2u);
  EXPECT_NE(reading.refused[0].message.find("fude/falcon-firmware.bin"), std::string::npos);
  EXPECT_TRUE(reading.samples.empty());
}

TEST(HapticReader, FirmwareThatTheArmDoesNotTakeIsSaidToo) {
  FalconDecoder decoder(image(), false);
  Reading reading;
  reading.arm.firmware = PowerOn(image());
  reading.run(decoder, 30'000, [](FalconArm& arm, int) { arm.muted = true; });
  ASSERT_EQ(reading.refused.size(), 1u);
  EXPECT_EQ(reading.refused[0].fault, Fault::unsupported);
}

TEST(HapticReader, SaysThatTheDeviceWentByItself) {
  HapticWish wish;
  wish.clock = std::make_unique<ManualClock>();
  auto& own = dynamic_cast<ManualClock&>(*wish.clock);
  auto arm = std::make_unique<FalconArm>(own);
  own.woke = [&arm = *arm, ms = 0](Timestamp) mutable { arm.gone = ++ms >= 100; };
  FalconDecoder decoder({}, false);
  std::atomic<bool> heard_so{false};
  HapticReader reader(
      std::move(arm), decoder,
      [&](const Transfer& transfer, std::span<const Sample>) {
        if (transfer.kind == TransferKind::unplugged) heard_so = true;
      },
      std::move(wish));
  while (!heard_so) std::this_thread::yield();
  EXPECT_TRUE(reader.stop());
}

}  // namespace
}  // namespace fude
