#include "rig/pen_manner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "rig/inputs.h"
#include "tests/rig/gesture.h"

namespace fude {
namespace {

constexpr Extent sheet{Millimetres(200), Millimetres(150)};

double degrees_of(const Lean& lean) { return std::atan(lean.norm()) * 180 / std::numbers::pi; }

TEST(PenManner, WordsReadBackAsTheSameManner) {
  for (const char* text : {"upright", "hand", "left-hand", "travel", "fixed:20,15", "fixed:-7.5,0"}) {
    const auto manner = parse_manner(text);
    ASSERT_TRUE(manner) << text;
    EXPECT_EQ(parse_manner(as_text(*manner)).value(), *manner) << text;
  }
  EXPECT_EQ(parse_manner("fixed").value(), parse_manner("fixed:20,15").value());
  for (const char* wrong : {"", "hands", "fixed:", "fixed:20", "fixed:20,", "fixed:20,15,3", "fixed:90,0",
                            "fixed:nan,0", "fixed:1;2"}) {
    const auto manner = parse_manner(wrong);
    ASSERT_FALSE(manner) << wrong;
    EXPECT_NE(manner.error().message.find("travel"), std::string::npos);
  }
}

TEST(HandManner, LeansToTheElbowMoreTheFurtherTheHandReaches) {
  const Lean middle = lean_of_hand({100, 75}, 0, sheet, false);
  EXPECT_GT(middle.x(), 0);  // to the right
  EXPECT_LT(middle.y(), 0);  // and towards the painter
  EXPECT_NEAR(degrees_of(middle), 20, 0.1);
  const Lean far = lean_of_hand({10, 140}, 0, sheet, false);
  const Lean near = lean_of_hand({190, 10}, 0, sheet, false);
  EXPECT_GT(degrees_of(far), degrees_of(middle) + 3);
  EXPECT_LT(degrees_of(near), degrees_of(middle) - 3);
  EXPECT_GT(degrees_of(lean_of_hand({100, 75}, 1, sheet, false)), degrees_of(middle) + 5);
  // The handle's line meets the elbow, seen from above.
  const Eigen::Vector2d elbow = Eigen::Vector2d(100, 75) + Eigen::Vector2d(140, -260);
  const Eigen::Vector2d way = elbow - Eigen::Vector2d(10, 140);
  EXPECT_NEAR(far.x() * way.y() - far.y() * way.x(), 0, 1e-9);
  // The left hand is the mirror image.
  const Lean left = lean_of_hand({190, 140}, 0, sheet, true);
  EXPECT_NEAR(left.x(), -far.x(), 1e-12);
  EXPECT_NEAR(left.y(), far.y(), 1e-12);
}

// The lean at the end of a curved way, sampled at `rate_hz`.
Lean followed(double rate_hz) {
  TrailingLean lean;
  const int count = static_cast<int>(std::lround(0.6 * rate_hz));
  for (int i = 0; i <= count; ++i) {
    const double t = i / rate_hz;
    lean.follow({60 * t, 20 * std::sin(4 * t)}, i == 0 ? 0 : 1 / rate_hz);
  }
  return lean.follow({36, 20 * std::sin(2.4)}, 0);
}

TEST(TravelManner, LeansAheadSoThatTheTipTrails) {
  TrailingLean lean;
  for (int i = 0; i <= 200; ++i) lean.follow({0.0, 0.5 * i}, 0.01);  // 50 mm/s, away from the painter
  const Lean drawn = lean.follow({0, 100}, 0);
  EXPECT_NEAR(drawn.x(), 0, 1e-9);
  EXPECT_NEAR(degrees_of(drawn), 29.5, 0.5);
  EXPECT_GT(drawn.y(), 0);
}

TEST(TravelManner, DoesNotDependOnTheRateOfTheEvents) {
  const Lean finest = followed(2000);
  double largest = 0;
  for (const double hz : {60.0, 125.0, 250.0, 1000.0})
    largest = std::max(largest, (followed(hz) - finest).norm() * 180 / std::numbers::pi);
  std::printf("figure: a trailing lean at 60 to 1000 Hz is within %.2f degrees of that at 2000 Hz\n",
              largest);
  EXPECT_LT(largest, 0.5);
}

TEST(TravelManner, KeepsItsLeanAtRestAndForgetsTheWayOverAGap) {
  TrailingLean lean;
  for (int i = 0; i <= 100; ++i) lean.follow({0.8 * i, 0.0}, 0.01);
  const Lean drawn = lean.follow({80, 0}, 0.01);
  for (int i = 0; i < 300; ++i) lean.follow({80, 0}, 0.01);
  EXPECT_GT(degrees_of(lean.follow({80, 0}, 0.01)), 0.5 * degrees_of(drawn));
  const Lean rested = lean.follow({80, 0}, 0.01);
  EXPECT_EQ(lean.follow({10, 100}, 3), rested);  // the jump is no way
}

TEST(HeldPens, FillInWhatADeviceDoesNotSenseAndNothingElse) {
  PenSample mouse = gesture::pen_at(0.1, 0.6, 10, 8);
  mouse.tilt_x.reset();
  const TabletMapping mapping = mapping_for(gesture::tablet(), sheet).value();
  HeldPens fixed(parse_manner("fixed:20,10").value(), sheet);
  EXPECT_NEAR(in_degrees(*fixed.held(1, mouse, mapping).tilt_x), 20, 1e-9);
  PenSample pen = mouse;
  pen.tilt_x = degrees(3);
  pen.tilt_y = degrees(4);
  EXPECT_EQ(fixed.held(1, pen, mapping), pen);
  PenSample away = mouse;
  away.in_proximity = false;
  EXPECT_EQ(fixed.held(1, away, mapping), away);
  HeldPens upright({}, sheet);
  EXPECT_EQ(upright.held(1, mouse, mapping), mouse);
}

TEST(HeldPens, LeanToTheSamePlaceOnATurnedTablet) {
  PenSample mouse = gesture::pen_at(0.1, 0.6, 18, 22);
  mouse.tilt_x.reset();
  TabletMapping straight = mapping_for(gesture::tablet(), sheet).value();
  TabletMapping turned = straight;
  turned.turn = Radians(0.7);
  const PenReach reach{.tuft_length = Millimetres(30)};
  const auto axis = [&](const TabletMapping& mapping, const PenManner& manner) {
    HeldPens held(manner, sheet);
    return Eigen::Vector3d(
        brush_move(held.held(1, mouse, mapping), mapping, reach).input.paper_from_handle.rotation *
        Eigen::Vector3d::UnitZ());
  };
  // Near the middle of the sheet the turn hardly moves the nib.
  const PenManner hand{HoldingManner::hand, {}, {}};
  EXPECT_LT((axis(straight, hand) - axis(turned, hand)).norm(), 0.02);
  const Lean lean = lean_of_hand(nib_on_paper(mouse, turned), mouse.pressure.value, sheet, false);
  EXPECT_LT((axis(turned, hand) - Eigen::Vector3d(lean.x(), lean.y(), 1).normalized()).norm(), 1e-9);
}

TEST(Manner, OfTheSessionGivesTheSamePictureAgainAndAnotherGivesAnother) {
  Session session = gesture::session(150, 1);
  for (RecordedPen& pen : session.pens) pen.sample.tilt_x.reset();
  ReplaySettings s = gesture::settings();
  const auto picture = [&](const char* manner) {
    s.wish.manner = parse_manner(manner).value();
    return replay(session, s, [](double) {}).value().report.picture_sha256;
  };
  const std::string travelling = picture("travel");
  EXPECT_EQ(picture("travel"), travelling);
  EXPECT_NE(picture("upright"), travelling);
  EXPECT_NE(picture("hand"), travelling);
}

}  // namespace
}  // namespace fude
