#include "rig/performance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "drivers/tablet/identify.h"
#include "drivers/tablet/pen_decoder.h"
#include "rig/performed_path.h"
#include "rig/replay.h"
#include "rig/share_folder.h"
#include "tests/fakes/recordings.h"
#include "tests/rig/glyph_outline.h"

namespace fude {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Performance bundled(const std::string& name) {
  const auto file = find_shared("performances", name, ".toml").value();
  return read_performance(text_of(file), file.string()).value();
}

Performance yong() { return bundled("yong"); }

// Through the real decoding, as `fude perform` writes it.
Session session_of(const Performance& performance) {
  const Performed performed = perform(performance);
  Session session;
  const DeviceDescription device = identified(*performed.recording.device);
  session.devices.push_back({1, device});
  PenDecoder decoder(device);
  InputOrder order = 1;
  auto action = performed.actions.begin();
  for (const Transfer& transfer : performed.recording.transfers) {
    for (; action != performed.actions.end() && action->time <= transfer.time; ++action)
      session.actions.push_back({order++, *action, std::nullopt});
    if (const auto sample = decoder.decode(transfer))
      session.pens.push_back({order++, 1, *sample, std::nullopt});
  }
  return session;
}

TEST(LeastJerk, StartsAndEndsAtRestAndIsSymmetric) {
  EXPECT_EQ(least_jerk(0), 0);
  EXPECT_EQ(least_jerk(1), 1);
  EXPECT_DOUBLE_EQ(least_jerk(0.5), 0.5);
  EXPECT_NEAR(least_jerk(0.2) + least_jerk(0.8), 1, 1e-15);
  EXPECT_NEAR((least_jerk(1e-4) - least_jerk(0)) / 1e-4, 0, 1e-6);            // no speed
  EXPECT_NEAR((least_jerk(0.501) - least_jerk(0.499)) / 0.002, 1.875, 1e-5);  // the bell's height
}

TEST(PerformedPath, PassesItsKnotsAndComesToRestAtItsBeats) {
  const std::vector<PerformedKnot> knots{
      {0, 0, 0.1, {}}, {10, 0, 0.5, {}}, {20, 5, 0.4, 1.0}, {20, 15, 0, 0.5}};
  const PerformedPath path(knots);
  EXPECT_DOUBLE_EQ(path.seconds(), 1.5);
  EXPECT_NEAR(path.at(0).x_mm, 0, 1e-9);
  EXPECT_NEAR(path.at(1).x_mm, 20, 1e-9);
  EXPECT_NEAR(path.at(1).y_mm, 5, 1e-9);
  EXPECT_NEAR(path.at(9).y_mm, 15, 1e-9);
  EXPECT_NEAR(std::abs(path.at(1.001).y_mm - path.at(0.999).y_mm) / 0.002, 0, 0.01);
  for (double t = 0; t < 1.5; t += 0.01) {
    EXPECT_GE(path.at(t).pressure, 0);
    EXPECT_LE(path.at(t).pressure, 0.5);  // monotone: no overshoot
  }
}

TEST(Performance, BadScriptsAreNamedByLine) {
  const auto message = [](const char* toml) { return read_performance(toml, "x.toml").error().message; };
  EXPECT_NE(message("name = ").find("line 1"), std::string::npos);
  EXPECT_NE(message("rate_hz = 200").find("width_mm"), std::string::npos);
  const char* head = "name='a'\nwidth_mm=10\nheight_mm=10\n";
  EXPECT_NE(read_performance(std::string(head) + "[[stroke]]\nknots=[[1,2]]\n", "x.toml")
                .error()
                .message.find("line 4"),
            std::string::npos);
  EXPECT_NE(read_performance(head, "x.toml").error().message.find("no [[stroke]]"), std::string::npos);
  EXPECT_FALSE(
      read_performance(std::string(head) + "[[stroke]]\nknots=[[1,2,0.5],[nan,2,0.5,1]]\n", "x").has_value());
}

TEST(Performance, LoadsRampsAndDipsInTheColoursOfItsPalette) {
  const auto p = read_performance(R"(
name = "a"
palette = "plum"
width_mm = 10
height_mm = 10
[[stroke]]
load = {stops = [{at = 0}, {at = 1, wetness = 0.5, hansa-yellow = 0.7, glue = 0}], far_stops = [{at = 0, ink = 0}]}
prepare = [{rinse = 2}, {wipe = 0.7}, {dip = {quinacridone-rose = 1.5}, depth_mm = 8}, {roll = 2}, {blot = 0.5, side = 0.25}, {reshape = true}]
knots = [[1, 2, 0.5], [3, 2, 0.5, 1]]
)",
                                  "x.toml");
  ASSERT_TRUE(p) << p.error().message;
  ASSERT_EQ(p->palette->pigments.size(), 3U);
  EXPECT_EQ(p->palette->pigments[1].name, "quinacridone-rose");
  const std::vector<decltype(Action::what)> expected{
      BrushCare(RinseBrush{2}),
      BrushCare(WipeBrush{0.7F}),
      BrushCare(DipBrush{8, 0.5F, {0, 1.5F, 0, 0.1F}}),
      BrushCare(RollBrush{2}),
      BrushCare(BlotBrush{0.5F, 0.25F}),
      ReshapeBrush{},
      BrushCare(
          GradeBrush{{{0, 1, {1, 0, 0, 0.1F}}, {1, 0.5F, {0, 0, 0.7F, 0}}}, {{0, 1, {0, 0, 0, 0.1F}}}})};
  EXPECT_EQ(p->strokes[0].prepare, expected);
  EXPECT_EQ(perform(*p).actions.size(), expected.size());
}

TEST(Performance, AColourThatIsNotOnThePaletteIsRefused) {
  const std::string head = "name='a'\nwidth_mm=10\nheight_mm=10\n";
  const std::string knots = "knots=[[1,2,0.5],[3,2,0.5,1]]\n";
  for (const char* wrong :
       {"load={hansa-yellow=1}", "load={stops=[]}", "load={stops=[{at=1},{at=0}]}",
        "prepare=[{dip={rose=1}, depth_mm=3}]", "prepare=[{dance=1}]", "prepare=3", "load={wetness=2}"})
    EXPECT_FALSE(read_performance(head + "[[stroke]]\n" + wrong + "\n" + knots, "x.toml")) << wrong;
  const auto nowhere = read_performance(head + "palette='none such'\n[[stroke]]\n" + knots, "x.toml");
  ASSERT_FALSE(nowhere);
  EXPECT_NE(nowhere.error().message.find("plum"), std::string::npos);
}

TEST(Performance, WhatIsDecodedIsWhatWasWritten) {
  const Performance script = yong();
  const Session session = session_of(script);
  int strokes = 0;
  bool touching = false;
  double highest = 0;
  for (const RecordedPen& pen : session.pens) {
    strokes += pen.sample.in_contact && !touching;
    touching = pen.sample.in_contact;
    highest = std::max(highest, pen.sample.pressure.value);
  }
  EXPECT_EQ(strokes, static_cast<int>(script.strokes.size()));
  double written = 0;
  for (const PerformedStroke& stroke : script.strokes)
    for (const PerformedKnot& knot : stroke.knots) written = std::max(written, knot.pressure);
  EXPECT_NEAR(highest, written, 0.01);
  ASSERT_TRUE(session.pens[200].sample.tilt_x.has_value());
  EXPECT_NEAR(in_degrees(*session.pens[200].sample.tilt_x), in_degrees(script.strokes[0].tilt_x), 1);
}

TEST(Performance, BundledSessionsAreTheirPerformances) {
  for (const char* name : {"yong", "bamboo"}) {
    SCOPED_TRACE(name);
    const Session written = session_of(bundled(name));
    const Session kept = read_session(find_shared("sessions", name, ".fude").value()).value();
    ASSERT_EQ(kept.pens.size(), written.pens.size());
    for (std::size_t i = 0; i < kept.pens.size(); ++i)
      ASSERT_EQ(kept.pens[i].sample, written.pens[i].sample) << i;
    ASSERT_EQ(kept.actions.size(), written.actions.size());
    for (std::size_t i = 0; i < kept.actions.size(); ++i)
      ASSERT_EQ(kept.actions[i].action, written.actions[i].action) << i;
  }
}

// Written at 60 mm to the em, the character covers its printed outline.
TEST(Yong, OverlapsItsOutline) {
  REQUIRE_RECORDING("glyphs/U+6C38.json");
  const auto json = nlohmann::json::parse(text_of(recordings() / "glyphs/U+6C38.json"));

  Performance script = yong();
  script.strokes.resize(5);  // the character without the wash
  ReplaySettings settings;
  settings.painting.brush = read_brush_spec(find_shared("brushes", "round-goat", ".toml")->string()).value();
  settings.painting.ink.paper = load_paper(find_shared("papers", "xuan", ".toml").value()).value();
  settings.painting.ink.cell_mm = 0.2;
  settings.reach = reach_of(settings.painting.brush);
  settings.palette.pigments = {pigments()[0]};
  const Picture picture = replay(session_of(script), settings, [](double) {})->picture;

  glyph::Mask ink{picture.width, picture.height, {}};
  constexpr std::uint16_t half_tone = 0x8000;
  for (int y = picture.height - 1; y >= 0; --y)
    for (const Rgb16& pixel : picture.row(y)) ink.cells.push_back(pixel[1] < half_tone);
  double best = 0;
  for (const double em_mm : {57.0, 58.5, 60.0, 61.5, 63.0}) {
    const glyph::Mask outline = glyph::fill(json["outlines_svg"].get<std::vector<std::string>>(), em_mm, 17,
                                            52, settings.painting.ink.cell_mm, ink.columns, ink.rows);
    best = std::max(best, glyph::best_overlap(outline, ink, 16));
  }
  std::printf("figure: 永 overlaps its outline by %.3f (intersection over union)\n", best);
  EXPECT_GE(best, 0.75);
}

}  // namespace
}  // namespace fude
