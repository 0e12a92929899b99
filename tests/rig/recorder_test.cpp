#include "rig/recorder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <thread>

namespace fude {
namespace {

std::filesystem::path scratch(const char* name) {
  const auto path =
      std::filesystem::temp_directory_path() / ("fude-" + std::to_string(getpid()) + "-" + name);
  std::filesystem::remove(path);
  return path;
}

TEST(Recorder, LosesNothingThatSeveralThreadsAdd) {
  const auto path = scratch("recorder.fude");
  auto recorder = Recorder::open(path).value();
  recorder->add(DeviceDescription{.name = "a"});
  recorder->add(DeviceDescription{.name = "b"});
  constexpr int each = 2000;
  const auto feed = [&](DeviceNumber device) {
    for (int i = 0; i < each; ++i) {
      RecordedPen pen;
      pen.device = device;
      pen.sample.time.sequence = static_cast<std::uint64_t>(i);
      pen.applied = i;
      recorder->add(pen);
    }
  };
  std::thread first(feed, 1);
  std::thread second(feed, 2);
  first.join();
  second.join();
  ASSERT_TRUE(recorder->close());

  const Session session = read_session(path).value();
  EXPECT_TRUE(session.complete);
  ASSERT_EQ(session.pens.size(), 2U * each);
  std::array<std::uint64_t, 3> next{};
  for (const RecordedPen& pen : session.pens) {
    EXPECT_EQ(pen.sample.time.sequence, next[static_cast<std::size_t>(pen.device)]++);
    EXPECT_EQ(pen.applied, static_cast<Step>(pen.sample.time.sequence));
  }
  std::filesystem::remove(path);
}

TEST(Recorder, AnEndWithoutCloseStillClosesTheFile) {
  const auto path = scratch("dropped.fude");
  {
    auto recorder = Recorder::open(path).value();
    recorder->add(SessionSetting{"brush", "round-goat"});
  }
  const Session session = read_session(path).value();
  EXPECT_TRUE(session.complete);
  EXPECT_EQ(session.settings.at("brush"), "round-goat");
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace fude
