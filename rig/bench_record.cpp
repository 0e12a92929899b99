#include "rig/bench_record.h"

#include <linux/input-event-codes.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <random>
#include <utility>

#include "capture/session.h"
#include "drivers/handle/report.h"
#include "drivers/transport/waker.h"
#include "drivers/vrpn/message.h"

namespace fude {
namespace {

// A device that sends one transfer a period, whether or not anybody reads.
class PacedSource final : public ByteSource {
 public:
  using Make = std::function<Transfer(std::uint64_t)>;
  PacedSource(Duration period, Make make, std::atomic<std::int64_t>& offered)
      : period_(period), make_(std::move(make)), offered_(offered), next_(monotonic_now() + period) {}

  Result<std::optional<Transfer>> read(std::optional<Timestamp>) override {
    std::unique_lock lock(mutex_);
    const auto due = std::chrono::steady_clock::time_point(next_.time_since_epoch());
    if (waiting_.wait_until(lock, due, [this] { return std::exchange(woken_, false); })) return std::nullopt;
    Transfer transfer = make_(sent_++);
    transfer.time = next_;
    transfer.stamped_by = StampedBy::kernel;
    next_ += period_;
    ++offered_;
    return transfer;
  }
  Result<void> write(const Transfer&) override { return {}; }
  void wake() override {
    {
      const std::lock_guard lock(mutex_);
      woken_ = true;
    }
    waiting_.notify_one();
  }

 private:
  Duration period_;
  Make make_;
  std::atomic<std::int64_t>& offered_;
  Timestamp next_;
  std::uint64_t sent_ = 0;
  std::mutex mutex_;
  std::condition_variable waiting_;
  bool woken_ = false;
};

constexpr Duration period(double hz) { return Duration(static_cast<std::int64_t>(1e9 / hz)); }

NamedDevice named(const char* word, const char* transport, std::string name, Duration every,
                  PacedSource::Make make, std::atomic<std::int64_t>& offered) {
  NamedDevice device;
  device.family = find_family(word, transport);
  device.description.name = std::move(name);
  device.description.kind = device.family->kind;
  device.description.transport = transport;
  device.open = [every, make = std::move(make), &offered]() -> Result<std::unique_ptr<ByteSource>> {
    return std::make_unique<PacedSource>(every, make, offered);
  };
  return device;
}

NamedDevice tablet(int number, std::atomic<std::int64_t>& offered) {
  const auto pen = [](std::uint64_t i) {
    const auto at = static_cast<std::int32_t>(i % 20000);
    std::vector<EvdevEvent> events{{EV_ABS, ABS_X, at},
                                   {EV_ABS, ABS_Y, 20000 - at},
                                   {EV_ABS, ABS_PRESSURE, 1 + at % 1000},
                                   {EV_SYN, SYN_REPORT, 0}};
    if (i == 0) events.insert(events.begin(), {{EV_KEY, BTN_TOOL_PEN, 1}, {EV_KEY, BTN_TOUCH, 1}});
    return Transfer{.kind = TransferKind::evdev_frame, .payload = pack_events(events)};
  };
  NamedDevice device =
      named("tablet", "evdev", "tablet " + std::to_string(number), period(300), pen, offered);
  device.description.keys = {BTN_TOOL_PEN, BTN_TOUCH};
  device.description.axes = {
      {ABS_X, 0, 20000, 0, 0, 100, 0}, {ABS_Y, 0, 20000, 0, 0, 100, 0}, {ABS_PRESSURE, 0, 1023, 0, 0, 0, 0}};
  return device;
}

NamedDevice brush_handle(int number, std::atomic<std::int64_t>& offered) {
  const auto report = [](std::uint64_t i) {
    handle::Motion motion;
    motion.sequence = static_cast<std::uint16_t>(i);
    motion.tick_us = static_cast<std::uint32_t>(1000 * i);
    motion.turn_rate = {static_cast<std::int16_t>(i % 1000), 20, -30};
    motion.specific_force = {0, 0, 4096};
    return Transfer{.kind = TransferKind::hid_report, .payload = handle::write_motion(motion)};
  };
  NamedDevice device =
      named("handle", "hidraw", "handle " + std::to_string(number), period(1000), report, offered);
  device.description.clock = DeviceClock{.nominal_tick = 1e-6};
  return device;
}

NamedDevice tracker(int number, std::atomic<std::int64_t>& offered) {
  const auto message = [](std::uint64_t i) {
    Transfer transfer{.kind = TransferKind::message};
    if (i == 0)
      transfer.payload = vrpn::write_cookie();
    else if (i == 1)
      transfer.payload = vrpn::write_description(vrpn::sender_description, 0, "Tracker0");
    else if (i == 2)
      transfer.payload = vrpn::write_description(vrpn::type_description, 0, vrpn::pose_type);
    else {
      vrpn::SensorPose pose;
      pose.pose.translation = {0.001 * static_cast<double>(i % 500), 0.1, 0.2};
      const std::vector<std::byte> body = vrpn::write_pose(pose);
      transfer.payload = vrpn::write_message({.time_us = 4167 * i, .sender = 0, .type = 0, .body = body});
    }
    return transfer;
  };
  return named("vrpn", "network", "tracker " + std::to_string(number), period(240), message, offered);
}

NamedDevice camera(std::size_t bytes, std::atomic<std::int64_t>& offered) {
  std::vector<std::byte> picture(bytes);
  std::mt19937 random(1);
  for (std::byte& byte : picture) byte = static_cast<std::byte>(random());
  const auto make = [picture](std::uint64_t) {
    return Transfer{.kind = TransferKind::picture, .payload = picture};
  };
  return named("camera", "v4l2", "camera", period(30), make, offered);
}

double processor_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto s = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return s(usage.ru_utime) + s(usage.ru_stime);
}

}  // namespace

Result<RecordBench> bench_record(const std::filesystem::path& session, double seconds,
                                 std::size_t picture_bytes) {
  std::atomic<std::int64_t> offered{0};
  RecordingWish wish{.overwrite = true, .named = {}};
  for (int i = 1; i <= 4; ++i) wish.named.push_back(tablet(i, offered));
  for (int i = 1; i <= 4; ++i) wish.named.push_back(brush_handle(i, offered));
  for (int i = 1; i <= 2; ++i) wish.named.push_back(tracker(i, offered));
  wish.named.push_back(camera(picture_bytes, offered));

  const double busy = processor_s();
  const auto start = std::chrono::steady_clock::now();
  auto recording = RecordingSession::start(session, std::move(wish), [](const std::string&) {});
  if (!recording) return tl::unexpected(recording.error());
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  auto streams = (*recording)->finish();
  if (!streams) return tl::unexpected(streams.error());
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  RecordBench bench{.streams = std::move(*streams), .offered = offered};
  bench.cores = (processor_s() - busy) / wall;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  bench.peak_mb = static_cast<double>(usage.ru_maxrss) * 1024 / 1e6;
  bench.session_mb = static_cast<double>(std::filesystem::file_size(session)) / 1e6;
  const auto written = read_session(session);
  if (!written) return tl::unexpected(written.error());
  bench.kept = std::ranges::count_if(written->transfers, [](const RecordedTransfer& t) {
    return t.transfer.direction == Direction::from_device && t.transfer.kind != TransferKind::plugged;
  });
  for (const RecordedStream& s : bench.streams) {
    bench.delay_us_p50 = std::max(bench.delay_us_p50, s.figures.delay_us.p50);
    bench.delay_us_p99 = std::max(bench.delay_us_p99, s.figures.delay_us.p99);
  }
  std::error_code ignored;
  std::filesystem::remove(session, ignored);
  return bench;
}

}  // namespace fude
