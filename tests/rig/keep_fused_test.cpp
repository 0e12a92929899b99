// A session with its fused poses beside it: nothing of the original lost, and the covariance comes out again.
#include "rig/fusion/keep_fused.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "capture/copy_session.h"
#include "capture/streams.h"
#include "rig/fusion/fix_of.h"
#include "rig/fusion/fuse_session.h"
#include "rig/session_identity.h"
#include "tests/rig/simulated_session.h"

namespace fude {
namespace {

std::filesystem::path fresh(const char* name) {
  const auto file = std::filesystem::path(testing::TempDir()) / name;
  std::filesystem::remove(file);
  return file;
}

// One of everything that a session can hold, as the file gives it back.
Session of_all_kinds() {
  Session session = session_of({}, "0002:0001:");
  session.samples.resize(400);
  for (std::size_t i = 0; i < session.samples.size(); ++i)
    session.samples[i].order = static_cast<InputOrder>(i + 1);
  session.devices.push_back({3, {.id = "0003:0001:", .name = "tablet", .kind = DeviceKind::pen_tablet}});
  PenSample pen;
  pen.time.host = at_second(2);
  session.pens.push_back({401, 3, pen, Step{7}});
  session.actions.push_back({402, {.time = at_second(2), .what = Undo{}}, Step{8}});
  session.transfers.push_back({3, {.time = at_second(2), .payload = {std::byte{1}, std::byte{2}}}});
  session.receipts.push_back({3, 10, 9, 1});
  session.passed_over.push_back({3, "noise", 4});
  session.calibrations.push_back({"tip", "tip_m = [0.0, 0.0, -0.1]"});
  session.settings["brush"] = "a brush";
  session.sheet = RecordedSheet{0, {std::byte{5}}};
  session.complete = true;
  return session;
}

Session written(const Session& session, const std::filesystem::path& file) {
  auto writer = SessionWriter::create(file);
  EXPECT_TRUE(writer && copy_session(session, *writer) && writer->close());
  return read_session(file).value();
}

TEST(KeepFused, ACopyIsTheSessionAgain) {
  const Session session = of_all_kinds();
  const Session copy = written(session, fresh("copy.fude"));
  EXPECT_EQ(session_identity(copy), session_identity(session));
  ASSERT_EQ(copy.devices.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(copy.devices[i].description, session.devices[i].description);
  ASSERT_EQ(copy.samples.size(), session.samples.size());
  for (std::size_t i = 0; i < copy.samples.size(); ++i) {
    EXPECT_EQ(copy.samples[i].order, session.samples[i].order);
    EXPECT_EQ(copy.samples[i].device, session.samples[i].device);
  }
  ASSERT_EQ(copy.pens.size(), 1U);
  EXPECT_EQ(copy.pens[0].applied, Step{7});
  EXPECT_EQ(copy.pens[0].order, 401);
  ASSERT_EQ(copy.actions.size(), 1U);
  EXPECT_EQ(copy.actions[0].applied, Step{8});
  ASSERT_EQ(copy.transfers.size(), 1U);
  EXPECT_EQ(copy.transfers[0].transfer.payload, session.transfers[0].transfer.payload);
  ASSERT_EQ(copy.receipts.size(), 1U);
  EXPECT_EQ(copy.receipts[0].dropped, 1);
  ASSERT_EQ(copy.passed_over.size(), 1U);
  EXPECT_EQ(copy.passed_over[0].what, "noise");
  ASSERT_EQ(copy.calibrations.size(), 1U);
  EXPECT_EQ(copy.calibrations[0].toml, session.calibrations[0].toml);
  EXPECT_EQ(copy.settings, session.settings);
  ASSERT_TRUE(copy.sheet);
  EXPECT_EQ(copy.sheet->state, session.sheet->state);
  EXPECT_TRUE(copy.complete);
}

TEST(KeepFused, BothPosesAreStreamsWithTheirCovariance) {
  const Session session = written(session_of({}, "0002:0001:"), fresh("original.fude"));
  const FuseWish wish{.use = fuse_sources("gyro,accel,pose").value()};
  FuseWish smooth = wish;
  smooth.smooth = true;
  const FusedSession causal = fuse_session(session, wish).value();
  const FusedSession smoothed = fuse_session(session, smooth).value();
  const auto file = fresh("kept.fude");
  ASSERT_TRUE(keep_fused(session, {causal, smoothed}, file, false));
  EXPECT_EQ(keep_fused(session, {causal, smoothed}, file, false).error().fault, Fault::exists);
  const Session kept = read_session(file).value();
  for (const auto& [tool, fused] : {std::pair("fused", &causal), std::pair("smoothed", &smoothed)}) {
    const auto stream = find_stream(kept, tool);
    ASSERT_TRUE(stream) << stream.error().message;
    ASSERT_EQ(stream->samples.size(), fused->rows.size());
    for (std::size_t i = 0; i < fused->rows.size(); i += 97) {
      const auto sample = std::get<PoseSample>(sample_at(kept, *stream, i));
      const FusedRow& row = fused->rows[i];
      EXPECT_EQ(sample.time.host, row.time);
      EXPECT_EQ(sample.valid, row.position_m.has_value());
      if (!sample.valid) continue;
      EXPECT_EQ(sample.tracker_from_tool.translation, *row.position_m);
      ASSERT_TRUE(sample.covariance);
      // Kept with the rotation first, and read again as a fix with the place first.
      EXPECT_EQ(sample.covariance->diagonal().tail<3>(), row.covariance.diagonal().head<3>());
      EXPECT_EQ(fix_of(sample).covariance, row.covariance);
    }
  }
  // Of what was there before nothing is missing, and the fusion of it is the same again: its own poses are no
  // source.
  EXPECT_EQ(kept.samples.size(), session.samples.size() + 2 * causal.rows.size());
  const FusedSession again = fuse_session(kept, wish).value();
  ASSERT_EQ(again.rows.size(), causal.rows.size());
  EXPECT_EQ(*again.rows.back().position_m, *causal.rows.back().position_m);
  ASSERT_TRUE(keep_fused(kept, {again, smoothed}, file, true));
  EXPECT_EQ(read_session(file)->samples.size(), kept.samples.size());
}

}  // namespace
}  // namespace fude
