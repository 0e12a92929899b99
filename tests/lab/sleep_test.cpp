// A kernel that is really suspended to memory, woken by its clock, with a pen that is down.
#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "drivers/tablet/pen_decoder.h"
#include "drivers/transport/evdev_source.h"
#include "drivers/transport/sleep_aware_source.h"
#include "tests/lab/attached_pen.h"
#include "tests/lab/session_recording.h"
#include "tests/lab/uinput_pen.h"

namespace fude::lab {
namespace {

bool write_to(const std::string& file, const std::string& text) {
  std::ofstream stream(file);
  stream << text << std::flush;
  return stream.good();
}

// False when the alarm came before the kernel was asleep: with the count of wake-ups it then stays awake
// instead of sleeping for ever.
bool sleep_for_seconds(int seconds) {
  const std::string alarm = "/sys/class/rtc/rtc0/wakealarm";
  std::string wakeups;
  std::ifstream("/sys/power/wakeup_count") >> wakeups;
  return write_to(alarm, "0") && write_to(alarm, "+" + std::to_string(seconds)) &&
         write_to("/sys/power/wakeup_count", wakeups) && write_to("/sys/power/state", "mem");
}

TEST(Sleep, APenThatWasDownGoesOnAfterAGap) {
  std::unique_ptr<UinputPen> pen;
  const DeviceNode found = attached_pen([&] { pen = std::make_unique<UinputPen>("lab pen"); });
  auto opened = EvdevSource::open(found.path);
  ASSERT_TRUE(opened) << opened.error().message;
  SleepAwareSource source(std::move(*opened), AfterSleep::goes_on, SleepWatch());
  SessionRecording recording(found.description);
  pen->move(100, 200, 300);
  ASSERT_EQ(recording.drain_until(source, 1), 1u);

  int seconds = 5;
  while (!sleep_for_seconds(seconds)) ASSERT_LT(seconds *= 2, 100) << "the kernel does not go to sleep";
  while (recording.last().kind != TransferKind::plugged) ASSERT_TRUE(recording.drain_one(source));
  pen->move(150, 200, 300);  // y stays: the kernel does not tell it again
  recording.drain(source);

  PenDecoder decoder(found.description);
  std::vector<PenSample> samples;
  std::vector<TransferKind> marks;
  for (const Transfer& transfer : recording.finish()) {
    if (transfer.kind != TransferKind::evdev_frame) marks.push_back(transfer.kind);
    if (const auto sample = decoder.decode(transfer)) samples.push_back(*sample);
  }
  EXPECT_EQ(marks, (std::vector{TransferKind::suspended, TransferKind::plugged}));
  ASSERT_EQ(samples.size(), 3u);
  EXPECT_TRUE(samples[0].in_contact);
  EXPECT_EQ(samples[1].tool, PenTool::none);
  EXPECT_TRUE(samples[2].in_contact);
  EXPECT_TRUE(samples[2].after_gap);
  EXPECT_EQ(samples[2].x_counts, 150);
  EXPECT_EQ(samples[2].y_counts, 200);
  EXPECT_EQ(decoder.counts().lost, 0u);
  std::printf("figure: a machine asleep for up to %d s, one gap\n", seconds);
}

}  // namespace
}  // namespace fude::lab
