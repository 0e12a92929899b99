// A machine that sleeps in the middle of a recording: the stream goes on in the same session, and the gap is
// seen in it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <vector>

#include "capture/export/csv_export.h"
#include "rig/record_session.h"
#include "rig/recorded_driver.h"
#include "rig/session_source.h"
#include "tests/fakes/family_streams.h"
#include "tests/fakes/transfers.h"

namespace fude {
namespace {

// A brush handle that answers as long as it has motions to tell; the machine sleeps before the last of them.
class Handle final : public ByteSource {
 public:
  Handle(unsigned first, unsigned last, std::function<void()> before_the_last, std::function<void()> silent)
      : next_(first), last_(last), before_the_last_(std::move(before_the_last)), silent_(std::move(silent)) {}

  Result<std::optional<Transfer>> read(std::optional<Timestamp>) override {
    std::unique_lock lock(mutex_);
    if (answer_) return std::exchange(answer_, std::nullopt);
    if (next_ > last_) {
      silent_();
      changed_.wait(lock, [this] { return woken_; });
      woken_ = false;
      return std::nullopt;
    }
    if (next_ == last_) before_the_last_();
    Transfer report = from_device(TransferKind::hid_report, handle_motion(next_++));
    report.time = monotonic_now();
    return report;
  }
  Result<void> write(const Transfer& transfer) override {
    if (transfer.kind != TransferKind::hid_ask) return {};
    answer_ = from_device(TransferKind::hid_feature, handle_scale());
    answer_->time = monotonic_now();
    return {};
  }
  void wake() override {
    const std::lock_guard lock(mutex_);
    woken_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool woken_ = false;
  unsigned next_, last_;
  std::function<void()> before_the_last_, silent_;
  std::optional<Transfer> answer_;
};

TEST(SleepRecording, TheStreamGoesOnAfterAGap) {
  const auto file =
      std::filesystem::path(testing::TempDir()) / ("fude-slept-" + std::to_string(getpid()) + ".fude");
  std::filesystem::remove(file);
  std::atomic<std::int64_t> asleep_s{0};
  const auto awake = [] { return monotonic_now().time_since_epoch(); };
  std::mutex mutex;
  std::condition_variable changed;
  bool told = false;

  RecordingWish wish{.sleep = SleepWatch(awake, [&] { return awake() + std::chrono::seconds(asleep_s); })};
  NamedDevice handle;
  handle.family = find_family("handle", "hidraw");
  handle.description.name = "handle";
  handle.description.kind = handle.family->kind;
  handle.description.transport = "hidraw";
  handle.description.vendor = handle.family->vendor;
  handle.description.product = handle.family->product;
  int opened = 0;
  handle.open = [&]() -> Result<std::unique_ptr<ByteSource>> {
    const auto sleep = [&, first = opened == 0] { asleep_s += first ? 3600 : 0; };
    const auto silent = [&] {
      const std::lock_guard lock(mutex);
      told = true;
      changed.notify_all();
    };
    const unsigned first = opened++ == 0 ? 0 : 5;
    return std::make_unique<Handle>(first, first + 4, sleep, silent);
  };
  wish.named.push_back(std::move(handle));
  auto recording = RecordingSession::start(file, std::move(wish), [](const std::string&) {});
  ASSERT_TRUE(recording) << recording.error().message;
  {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return told; });
  }
  ASSERT_TRUE((*recording)->finish());
  EXPECT_EQ(opened, 2);

  const auto session = read_session(file);
  ASSERT_TRUE(session) << session.error().message;
  ASSERT_EQ(session->devices.size(), 1u);
  std::vector<TransferKind> marks;
  int greetings = 0;
  for (const RecordedTransfer& t : session->transfers) {
    greetings += t.transfer.kind == TransferKind::hid_ask;
    if (t.transfer.payload.empty() && t.transfer.direction == Direction::from_device)
      marks.push_back(t.transfer.kind);
  }
  EXPECT_EQ(marks, (std::vector{TransferKind::plugged, TransferKind::suspended, TransferKind::plugged}));
  EXPECT_EQ(greetings, 2);
  ASSERT_EQ(session->samples.size(), 10u);
  std::vector<Sample> live;
  for (const RecordedSample& s : session->samples) live.push_back(s.sample);
  for (std::size_t i = 0; i < live.size(); ++i) EXPECT_EQ(after_gap(live[i]), i == 5) << i;

  // The recording through the driver once more, and as a table.
  const auto transfers = transfers_of(*session, 1);
  RecordedDriver driver(session->devices[0].description, transfers);
  std::vector<Sample> again;
  for (const Transfer& transfer : transfers) driver.decode(transfer, again);
  EXPECT_EQ(again.size(), live.size());
  for (std::size_t i = 0; i < again.size(); ++i) {
    EXPECT_EQ(after_gap(again[i]), i == 5) << i;
    EXPECT_EQ(time_of(again[i]), time_of(live[i]));
  }
  const std::string table = csv_of(*session, streams_of(*session).at(0));
  const std::size_t names = table.find('\n') + 1;
  const std::size_t rows = table.find('\n', names) + 1;
  const std::string header = table.substr(names, rows - names);
  EXPECT_EQ(header.substr(header.rfind(',') + 1), "after_gap\n");
  std::string gaps;
  for (std::size_t at = rows; at < table.size();) {
    const std::size_t end = table.find('\n', at);
    gaps += table[end - 1];
    at = end + 1;
  }
  EXPECT_EQ(gaps, "0000010000");
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace fude
