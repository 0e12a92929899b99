#include "sim/brush/brush.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "tests/sim/brush/gesture.h"

namespace fude {
namespace {

Pose<Paper, Handle> hand(double t) {
  return leaning(30 * ease((t - 0.2) / 0.6), 5 * std::sin(4 * t),
                 33 - 12 * ease(t / 0.2) + 15 * ease((t - 0.8) / 0.2), 0.25, 0.5);
}

bool same(const std::optional<Deposit>& a, const std::optional<Deposit>& b) {
  if (a.has_value() != b.has_value()) return false;
  if (!a) return true;
  return a->map.left_mm == b->map.left_mm && a->map.columns == b->map.columns &&
         a->map.fresh == b->map.fresh && a->map.contact_s == b->map.contact_s && a->map.patch == b->map.patch;
}

Brush dipped() {
  Brush brush(BrushSpec{}, 9);
  brush.load(0.4F, {1, 0.2F, 0, 0.1F});
  brush.expect_film(0.05);
  return brush;
}

TEST(Brush, GoesOnExactlyFromItsBytes) {
  Brush brush = dipped();
  int i = 0;
  for (; i < 90; ++i) brush.move(input_at(0.005 * i, hand(0.005 * i)));
  const std::vector<std::byte> bytes = bytes_of(brush.state());
  const auto state = brush_state_of(bytes);
  ASSERT_TRUE(state) << state.error().message;
  EXPECT_EQ(bytes_of(*state), bytes);
  Brush other = dipped();
  other.restore(*state);
  int marks = 0;
  for (; i < 240; ++i) {
    const BrushFrame a = brush.move(input_at(0.005 * i, hand(0.005 * i)));
    const BrushFrame b = other.move(input_at(0.005 * i, hand(0.005 * i)));
    ASSERT_TRUE(same(a.deposit, b.deposit)) << i;
    marks += a.deposit ? 1 : 0;
  }
  EXPECT_GT(marks, 30);
  EXPECT_EQ(bytes_of(brush.state()), bytes_of(other.state()));
}

TEST(Brush, RefusesBytesThatAreNoState) {
  Brush brush = dipped();
  brush.move(input_at(0, hand(0)));
  const std::vector<std::byte> bytes = bytes_of(brush.state());
  EXPECT_FALSE(brush_state_of({}));
  EXPECT_FALSE(brush_state_of(std::span(bytes).first(bytes.size() - 1)));
  std::vector<std::byte> longer = bytes;
  longer.push_back(std::byte{0});
  EXPECT_FALSE(brush_state_of(longer));
  for (std::size_t i = 0; i < 24; ++i) {
    std::vector<std::byte> bad = bytes;
    bad[i] ^= std::byte{0xff};
    EXPECT_FALSE(brush_state_of(bad)) << i;
  }
}

TEST(Brush, RefusesTheStateOfAnotherTuft) {
  BrushSpec spec;
  spec.segments = 5;
  Brush other(spec, 9);
  EXPECT_THROW(other.restore(dipped().state()), std::invalid_argument);
}

TEST(Brush, MarksOnlyWhereItIs) {
  Brush brush = dipped();
  for (int i = 0; i < 60; ++i) brush.move(input_at(0.005 * i, hand(0.005 * i)));
  BrushInput away = input_at(0.31, hand(0.3));
  away.origin = PoseOrigin::none;
  EXPECT_FALSE(brush.move(away).deposit);
  // Back at another place: a new touch, no sweep from the old one.
  const BrushFrame back = brush.move(input_at(0.32, leaning(80, 50, 22, 0.25, 0.5)));
  ASSERT_TRUE(back.deposit);
  EXPECT_GT(back.deposit->map.left_mm, 50);
}

TEST(Brush, ReshapeStraightensAndKeepsTheInk) {
  Brush brush = dipped();
  for (int i = 0; i < 100; ++i) brush.move(input_at(0.005 * i, hand(0.005 * i)));
  const double water = wetness(brush.state().loading);
  brush.reshape();
  EXPECT_TRUE(brush.state().tufts.front().state.x.isZero());
  EXPECT_EQ(wetness(brush.state().loading), water);
}

TEST(Brush, SurvivesWhatDevicesSend) {
  Brush brush = dipped();
  const double bad = std::numeric_limits<double>::quiet_NaN();
  const double huge = std::numeric_limits<double>::max();
  double t = 0;
  for (int i = 0; i < 60; ++i) {
    BrushInput input = input_at(t, hand(0.3));
    t += i % 7 == 3 ? -0.5 : i % 7 == 5 ? 100 : 0.01;  // back, far ahead
    if (i % 5 == 1) input.paper_from_handle.translation.x() = bad;
    if (i % 5 == 2) input.paper_from_handle.translation.z() = -huge;
    if (i % 5 == 3) input.paper_from_handle.rotation.coeffs().setZero();
    if (i % 11 == 4) input.time.host = Timestamp::max();
    if (i % 11 == 5) input.time.host = Timestamp::min();
    const BrushFrame frame = brush.move(input);
    EXPECT_TRUE(brush.state().tufts.front().state.x.allFinite());
    if (!frame.deposit) continue;
    EXPECT_LT(frame.deposit->map.fresh.size(), 3'000'000U);
    for (const float f : frame.deposit->map.fresh) ASSERT_TRUE(f >= 0 && f <= 1);
    for (const float s : frame.deposit->map.contact_s) ASSERT_TRUE(s >= 0 && s <= 1);
  }
}

TEST(Brush, DepositNamesItsPatches) {
  Brush brush = dipped();
  for (int i = 0; i < 120; ++i) {
    const BrushFrame frame = brush.move(input_at(0.005 * i, hand(0.005 * i)));
    if (!frame.deposit) continue;
    ASSERT_EQ(frame.deposit->patches.size(), static_cast<std::size_t>(patch_count));
    for (const std::uint16_t patch : frame.deposit->map.patch) ASSERT_LT(patch, patch_count);
  }
}

TEST(Brush, ManualListsEveryParameter) {
  std::ifstream file(FUDE_BRUSH_MANUAL);
  const std::string manual{std::istreambuf_iterator<char>(file), {}};
  ASSERT_FALSE(manual.empty()) << FUDE_BRUSH_MANUAL;
  for (const std::string& row : brush_manual_rows()) EXPECT_NE(manual.find(row), std::string::npos) << row;
}

TEST(Brush, SharedBrushesAreRead) {
  const auto spec = read_brush_spec(FUDE_ROUND_GOAT);
  ASSERT_TRUE(spec) << spec.error().message;
  EXPECT_EQ(spec->name, "round-goat");
}

}  // namespace
}  // namespace fude
