// What a round brush does under the hand (Chu, figure 2.17), as the geometry of its strokes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "tests/sim/brush/gesture.h"

namespace fude {
namespace {

// A stroke along x: where its edges and the tip of the brush were, and how much was covered, for each
// millimetre.
struct Stroke {
  static constexpr int length_mm = 60;
  std::vector<double> low = std::vector<double>(length_mm, 1e9);
  std::vector<double> high = std::vector<double>(length_mm, -1e9);
  std::vector<double> film = std::vector<double>(length_mm);
  std::vector<double> tip = std::vector<double>(length_mm, 1e9);
  double width(int mm) const {
    const auto i = static_cast<std::size_t>(mm);
    return std::max(0.0, high[i] - low[i]);
  }
  double covered(int from_mm, int to_mm) const {
    double sum = 0;
    for (int mm = from_mm; mm < to_mm; ++mm)
      sum += film[static_cast<std::size_t>(mm)] / std::max(width(mm), 0.1);
    return sum / (to_mm - from_mm);
  }
};

Stroke drawn(Brush& brush, const Gesture& gesture) {
  Stroke stroke;
  const auto place = [](double x) {
    return static_cast<std::size_t>(std::clamp(x, 0.0, Stroke::length_mm - 1.0));
  };
  for (double t = 0; t < gesture.seconds; t += 0.004) {
    const BrushFrame frame = brush.move(input_at(t, gesture.pose(t)));
    const Eigen::Vector3d tip = brush.shape().front().spine.back();
    stroke.tip[place(tip.x())] = tip.y();
    if (!frame.deposit) continue;
    const FootprintMap& map = frame.deposit->map;
    for (int r = 0; r < map.rows; ++r)
      for (int c = 0; c < map.columns; ++c) {
        const auto fresh = static_cast<double>(map.fresh[static_cast<std::size_t>(r * map.columns + c)]);
        if (fresh <= 0) continue;
        const double y = map.bottom_mm + (r + 0.5) * map.cell_mm;
        const std::size_t i = place(map.left_mm + (c + 0.5) * map.cell_mm);
        stroke.low[i] = std::min(stroke.low[i], y);
        stroke.high[i] = std::max(stroke.high[i], y);
        stroke.film[i] += fresh * map.cell_mm * map.cell_mm;
      }
  }
  return stroke;
}

// Drawn 60 mm along x, leaning by `tilt` towards a direction, pressed by `depth(way)`.
template <class Depth>
Gesture along_x(double tilt, double towards, Depth depth) {
  return {1.5, [=](double t) {
            const double share = ease((t - 0.3) / 1.1);
            return leaning(60 * share, 0, 33 - depth(share) * ease(t / 0.3), tilt, towards);
          }};
}

Brush loaded(float wetness) {
  Brush brush(BrushSpec{}, 5);
  brush.load(wetness, {1, 0, 0, 0.1F});
  return brush;
}

// Of the tip across the stroke: 0 on the lower edge, 1 on the upper.
double tip_across(const Stroke& stroke) {
  double sum = 0;
  int count = 0;
  for (std::size_t mm = 20; mm < 40; ++mm) {
    if (stroke.tip[mm] > 1e8) continue;
    sum += (stroke.tip[mm] - stroke.low[mm]) / (stroke.high[mm] - stroke.low[mm]);
    ++count;
  }
  return sum / count;
}

TEST(Brushwork, ACentralTipRunsInTheMiddleAndABiasedOneAlongAnEdge) {
  Brush one = loaded(1);
  const double central = tip_across(drawn(one, along_x(0.2, 0, [](double) { return 10.0; })));
  Brush other = loaded(1);
  const double biased =
      tip_across(drawn(other, along_x(0.7, -0.5 * std::numbers::pi, [](double) { return 12.0; })));
  std::printf("figure: across the stroke a central tip runs at %.2f, a biased one at %.2f of the width\n",
              central, biased);
  EXPECT_NEAR(central, 0.5, 0.1);
  EXPECT_LT(std::min(biased, 1 - biased), 0.25);
}

TEST(Brushwork, ABladeEndsInAPoint) {
  Brush brush = loaded(1);
  const Stroke stroke = drawn(brush, along_x(0.15, 0, [](double way) { return 12 - 13 * way; }));
  int end = Stroke::length_mm - 2;
  while (end > 0 && stroke.width(end) == 0) --end;
  std::printf("figure: a blade is %.1f mm wide at its middle, %.1f mm 10 and %.1f mm 2 mm before its end\n",
              stroke.width(end / 2), stroke.width(end - 10), stroke.width(end - 2));
  EXPECT_LT(stroke.width(end - 10), 0.8 * stroke.width(end / 2));
  EXPECT_LT(stroke.width(end - 2), 0.5 * stroke.width(end / 2));
}

TEST(Brushwork, ADryingStrokeCoversLessAndLess) {
  BrushSpec spec;
  spec.capacity_ul = 60;
  Brush brush(spec, 5);
  brush.load(0.5F, {1, 0, 0, 0.1F});
  brush.expect_film(0.06);
  const Stroke stroke = drawn(brush, along_x(0.3, 0, [](double) { return 11.0; }));
  const double begins = stroke.covered(8, 20);
  const double ends = stroke.covered(40, 52);
  std::printf("figure: a drying stroke covers %.2f of its width at first and %.2f at last\n", begins, ends);
  EXPECT_LT(ends, 0.8 * begins);
}

}  // namespace
}  // namespace fude
