// A recording program that is killed leaves a session that opens.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <random>
#include <thread>
#include <vector>

#include "capture/picture/frame_encoding.h"
#include "capture/picture/picture_png.h"
#include "drivers/transport/waker.h"
#include "rig/frame_keeper.h"
#include "rig/recorder.h"

namespace fude {
namespace {

constexpr int kills = 100;
constexpr int devices = 4;

void remove_session(const std::filesystem::path& path) {
  for (const char* suffix : {"", "-wal", "-shm", "-journal"}) std::filesystem::remove(path.string() + suffix);
}

std::filesystem::path session_path() {
  return std::filesystem::temp_directory_path() / ("fude-killed-" + std::to_string(getpid()) + ".fude");
}

// Runs `child`, which writes a byte to the pipe when it has begun, and kills it so long after that. Gives
// when.
template <class Child>
Timestamp kill_in_the_middle(std::chrono::milliseconds life, const Child& child) {
  int begun[2];
  EXPECT_EQ(pipe(begun), 0);
  const pid_t recording = fork();
  EXPECT_GE(recording, 0);
  if (recording == 0) child(begun[1]);
  char byte = 0;
  EXPECT_EQ(read(begun[0], &byte, 1), 1);
  close(begun[0]);
  close(begun[1]);
  std::this_thread::sleep_for(life);
  kill(recording, SIGKILL);
  const Timestamp killed = monotonic_now();
  int status = 0;
  waitpid(recording, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "the child ended by itself";
  return killed;
}

// In the child: a transfer of each device every millisecond, stamped when it is added. Says by one byte
// when it has begun.
[[noreturn]] void record_until_killed(const std::filesystem::path& path, int begun) {
  auto recorder = Recorder::open(path);
  if (!recorder || write(begun, "b", 1) != 1) _exit(1);
  for (int d = 0; d < devices; ++d) (*recorder)->add(DeviceDescription{.name = std::to_string(d)});
  for (;;) {
    for (DeviceNumber d = 1; d <= devices; ++d)
      (*recorder)->add(RecordedTransfer{
          d, {.time = monotonic_now(), .kind = TransferKind::serial, .payload = {std::byte{1}}}});
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

TEST(Killed, ARecordingOpensEachTimeAndHoldsAllButTheLastMoment) {
  const auto path = session_path();
  std::mt19937 random(9);
  std::uniform_int_distribution<int> life_ms(5, 150);
  double longest_missing_ms = 0;
  for (int i = 0; i < kills; ++i) {
    remove_session(path);
    const Timestamp killed = kill_in_the_middle(std::chrono::milliseconds(life_ms(random)),
                                                [&](int begun) { record_until_killed(path, begun); });
    const auto session = read_session(path);
    ASSERT_TRUE(session) << session.error().message;
    EXPECT_FALSE(session->complete);
    // Whole rounds up to some moment, in order: nothing in between is missing.
    Timestamp last{};
    for (std::size_t t = 0; t < session->transfers.size(); ++t) {
      EXPECT_EQ(session->transfers[t].device, static_cast<DeviceNumber>(t % devices) + 1);
      EXPECT_GE(session->transfers[t].transfer.time, last);
      last = session->transfers[t].transfer.time;
    }
    if (!session->transfers.empty())
      longest_missing_ms = std::max(longest_missing_ms, seconds(killed - last) * 1e3);
  }
  // A figure and no condition: a busy machine's disk may take its time.
  std::printf("figure: killed %d times in mid-recording, at most %.0f ms missing\n", kills,
              longest_missing_ms);
  remove_session(path);
}

constexpr int picture_kills = 20;
constexpr std::int32_t width = 1280, height = 720;

// A camera's yuyv, with a sensor's noise, each picture another.
std::vector<std::byte> picture(std::size_t number) {
  std::mt19937 random(static_cast<unsigned>(number));
  std::vector<std::byte> bytes(2 * width * height);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<std::byte>(i % 2 == 0 ? i / 8192 + random() % 8 : 126 + random() % 4);
  return bytes;
}

// What the child handed over, where the parent sees it whatever becomes of the child.
struct HandedOver {
  std::atomic<std::size_t> count{0};
  std::array<Timestamp, 256> times{};
};

// In the child: `fude record --frames png` of a camera of 30 pictures a second.
[[noreturn]] void film_until_killed(const std::filesystem::path& path, int begun, HandedOver& handed,
                                    const std::vector<std::vector<std::byte>>& pictures) {
  auto recorder = Recorder::open(path);
  if (!recorder) _exit(1);
  (*recorder)->add(DeviceDescription{.name = "camera", .kind = DeviceKind::camera});
  FrameKeeper keeper([](std::span<const std::byte> bytes,
                        CameraFrame& frame) { return encoded(bytes, frame, FrameEncoding::png); },
                     [&](Transfer transfer, std::optional<CameraFrame> frame) {
                       (*recorder)->add(RecordedTransfer{1, std::move(transfer)});
                       (*recorder)->add(RecordedSample{1, *frame, 0});
                     });
  if (write(begun, "b", 1) != 1) _exit(1);
  auto due = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < handed.times.size(); ++i) {
    const Timestamp now = monotonic_now();
    CameraFrame frame{.time = {.host = now, .sequence = i}, .format = PixelFormat::yuyv};
    frame.width = width;
    frame.height = height;
    handed.times[i] = now;
    handed.count = i + 1;
    keeper.add({.time = now, .kind = TransferKind::picture, .payload = pictures[i % pictures.size()]}, frame);
    due += std::chrono::microseconds(33333);
    std::this_thread::sleep_until(due);
  }
  for (;;) pause();  // whoever kills may be late
}

TEST(Killed, ACamerasPicturesAreThereButForTheLastMoment) {
  const auto path = session_path();
  std::vector<std::vector<std::byte>> pictures;
  for (std::size_t i = 0; i < 3; ++i) pictures.push_back(picture(i));
  void* shared = mmap(nullptr, sizeof(HandedOver), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  std::mt19937 random(11);
  std::uniform_int_distribution<int> life_ms(30, 230);
  double longest_missing_ms = 0;
  std::size_t kept = 0, kept_as_png = 0, handed_over = 0;
  for (int i = 0; i < picture_kills; ++i) {
    remove_session(path);
    auto& handed = *new (shared) HandedOver;
    const Timestamp killed = kill_in_the_middle(std::chrono::milliseconds(life_ms(random)), [&](int begun) {
      film_until_killed(path, begun, handed, pictures);
    });
    const auto session = read_session(path);
    ASSERT_TRUE(session) << session.error().message;
    // What was handed over, from the first picture on, without a hole, bit for bit.
    ASSERT_LE(session->transfers.size(), handed.count);
    for (std::size_t p = 0; p < session->transfers.size(); ++p) {
      const Transfer& transfer = session->transfers[p].transfer;
      ASSERT_EQ(transfer.time, handed.times[p]);
      const auto png = raw_from_png(transfer.payload);
      ASSERT_TRUE((png ? png->bytes : transfer.payload) == pictures[p % pictures.size()]);
      kept_as_png += png.has_value();
    }
    // Its frame follows a picture; the end may have come between them.
    ASSERT_LE(session->samples.size(), session->transfers.size());
    ASSERT_LE(session->transfers.size(), session->samples.size() + 1);
    kept += session->transfers.size();
    handed_over += handed.count;
    if (session->transfers.size() < handed.count)
      longest_missing_ms =
          std::max(longest_missing_ms, seconds(killed - handed.times[session->transfers.size()]) * 1e3);
  }
  std::printf(
      "figure: killed %d times while filming 1280 x 720 as PNG, at most the last %.0f ms missing; of %zu "
      "pictures %zu kept, %zu of them as PNG\n",
      picture_kills, longest_missing_ms, handed_over, kept, kept_as_png);
  munmap(shared, sizeof(HandedOver));
  remove_session(path);
}

}  // namespace
}  // namespace fude
