// A pivot from a tracker that answers as it would on the network, with and without its motions kept.
#include "rig/calibration/live_calibration.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <condition_variable>
#include <mutex>

#include "calibration/pivot.h"
#include "drivers/openigtlink/content.h"
#include "rig/calibration/calibrate_session.h"
#include "rig/calibration/known_calibrations.h"
#include "rig/calibration/pivot.h"
#include "rig/session_identity.h"
#include "tests/fakes/scripted_tracker.h"

namespace fude {
namespace {

// Whether the source was asked for more than it had: then all was heard.
class Silence {
 public:
  void begins() {
    const std::lock_guard lock(mutex_);
    begun_ = true;
    changed_.notify_all();
  }
  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return begun_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool begun_ = false;
};

class Peer final : public ByteSource {
 public:
  Peer(std::vector<Transfer> messages, Silence& silence)
      : messages_(std::move(messages)), silence_(silence) {}

  Result<std::optional<Transfer>> read(std::optional<Timestamp>) override {
    if (next_ < messages_.size()) return messages_[next_++];
    silence_.begins();
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return woken_; });
    woken_ = false;
    return std::nullopt;
  }
  void wake() override {
    const std::lock_guard lock(mutex_);
    woken_ = true;
    changed_.notify_all();
  }

 private:
  std::vector<Transfer> messages_;
  Silence& silence_;
  std::size_t next_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool woken_ = false;
};

NamedDevice tracker_that_pivots(const ScriptedPivot& script, Silence& silence) {
  NamedDevice named;
  named.family = find_family("openigtlink", "network");
  named.description = {.id = "0000:0000:peer:18944",
                       .name = "tracker",
                       .kind = named.family->kind,
                       .transport = named.family->transport,
                       .serial = "peer:18944"};
  std::vector<Transfer> messages;
  for (const PoseSample& pose : script.samples())
    messages.push_back({.time = pose.time.host + std::chrono::seconds(1),
                        .kind = TransferKind::message,
                        .payload = openigtlink::write_transform("brush", 0, pose.tracker_from_tool)});
  named.open = [messages, &silence]() -> Result<std::unique_ptr<ByteSource>> {
    return std::make_unique<Peer>(messages, silence);
  };
  return named;
}

double tip_error_m(const CalibrationOutcome& outcome, const ScriptedPivot& script) {
  const auto tip = outcome.result ? numbers_in(*outcome.result, "tip_m") : std::nullopt;
  return tip ? (Eigen::Vector3d(tip->data()) - script.tip_m).norm() : 1;
}

TEST(LiveCalibration, HearsADeviceUntilItIsEnded) {
  const ScriptedPivot script;
  Silence silence;
  const auto calibrator = pivot_calibrator({});
  LiveWish wish;
  wish.named.push_back(tracker_that_pivots(script, silence));
  const auto live = LiveCalibration::start(*calibrator, std::move(wish), [](const std::string&) {});
  ASSERT_TRUE(live) << live.error().message;
  silence.wait();
  const auto outcome = (*live)->finish();
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_LT(tip_error_m(*outcome, script), 1e-6) << outcome->report.reason;
  EXPECT_EQ(outcome->report.devices, std::vector<std::string>{"0000:0000:peer:18944"});
  EXPECT_EQ((*live)->progress()->samples, script.samples().size());
}

TEST(LiveCalibration, TheMotionsThatAreKeptGiveTheSameAndCarryAPassport) {
  const auto file =
      std::filesystem::path(testing::TempDir()) / ("fude-live-" + std::to_string(getpid()) + ".fude");
  const ScriptedPivot script;
  Silence silence;
  const auto calibrator = pivot_calibrator({});
  LiveWish wish;
  wish.named.push_back(tracker_that_pivots(script, silence));
  wish.session = file;
  for (const char* device : {"0000:0000:peer:18944", "0f44:ff20:A"}) {
    StoredCalibration earlier;
    earlier.report = {.procedure = "pivot", .accepted = true, .devices = {device}, .tool = "brush"};
    earlier.result = {{"tip_m", std::vector{1.0, 2.0, 3.0}}};
    wish.calibrations.push_back(earlier);
  }
  const auto live = LiveCalibration::start(*calibrator, std::move(wish), [](const std::string&) {});
  ASSERT_TRUE(live) << live.error().message;
  silence.wait();
  const auto outcome = (*live)->finish();
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_LT(tip_error_m(*outcome, script), 1e-6) << outcome->report.reason;

  const auto session = read_session(file);
  std::filesystem::remove(file);
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_TRUE(session->complete);
  EXPECT_EQ(outcome->report.session, session_identity(*session));
  const auto again = calibrate_session(*pivot_calibrator({}), *session);
  ASSERT_TRUE(again && again->result);
  EXPECT_EQ(numbers_in(*again->result, "tip_m"), numbers_in(*outcome->result, "tip_m"));
  ASSERT_EQ(session->calibrations.size(), 1U);  // the other's device was not there
  KnownCalibrations known;
  known.carry(*session);
  EXPECT_EQ(tip_of("surface", {}, known, {1, session->devices.front().description, "brush"})->z(), 3);
}

TEST(LiveCalibration, AnExistingSessionIsNotReplaced) {
  const auto file =
      std::filesystem::path(testing::TempDir()) / ("fude-live-there-" + std::to_string(getpid()) + ".fude");
  std::fclose(std::fopen(file.c_str(), "w"));
  Silence silence;
  const auto calibrator = pivot_calibrator({});
  LiveWish wish;
  wish.named.push_back(tracker_that_pivots({}, silence));
  wish.session = file;
  const auto live = LiveCalibration::start(*calibrator, std::move(wish), [](const std::string&) {});
  std::filesystem::remove(file);
  ASSERT_FALSE(live);
  EXPECT_EQ(live.error().fault, Fault::exists);
}

}  // namespace
}  // namespace fude
