// A recording program that is killed leaves a session that opens.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <random>
#include <thread>

#include "drivers/transport/waker.h"
#include "rig/recorder.h"

namespace fude {
namespace {

constexpr int kills = 100;
constexpr int devices = 4;

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
  const auto path =
      std::filesystem::temp_directory_path() / ("fude-killed-" + std::to_string(getpid()) + ".fude");
  std::mt19937 random(9);
  std::uniform_int_distribution<int> life_ms(5, 150);
  double longest_missing_ms = 0;
  for (int i = 0; i < kills; ++i) {
    for (const char* suffix : {"", "-wal", "-shm", "-journal"})
      std::filesystem::remove(path.string() + suffix);
    int begun[2];
    ASSERT_EQ(pipe(begun), 0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) record_until_killed(path, begun[1]);
    char byte = 0;
    ASSERT_EQ(read(begun[0], &byte, 1), 1);
    close(begun[0]);
    close(begun[1]);
    std::this_thread::sleep_for(std::chrono::milliseconds(life_ms(random)));
    kill(child, SIGKILL);
    const Timestamp killed = monotonic_now();
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the child ended by itself";

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
  for (const char* suffix : {"", "-wal", "-shm", "-journal"}) std::filesystem::remove(path.string() + suffix);
}

}  // namespace
}  // namespace fude
