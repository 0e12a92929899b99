#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "sim/ink/paper_texture.h"

namespace fude {
namespace {

using Cells = std::array<Texture, tile::cells>;

Cells sample(std::uint64_t seed, int left, int bottom, double cell_mm = 0.1) {
  PaperSpec paper;
  paper.alum_density = 0.5;
  Cells cells;
  PaperTexture(paper, seed, cell_mm, 4096, 4096, true).sample(left, bottom, cells.data());
  return cells;
}

TEST(PaperTexture, IsAFunctionOfSeedAndPlaceAlone) {
  const Cells here = sample(5, 320, 640);
  const Cells shifted = sample(5, 320 + 7, 640 + 11);
  for (int y = 11; y < tile::side; ++y)
    for (int x = 7; x < tile::side; ++x) {
      const Texture& a = here[static_cast<std::size_t>(y * tile::side + x)];
      const Texture& b = shifted[static_cast<std::size_t>((y - 11) * tile::side + x - 7)];
      ASSERT_FLOAT_EQ(a.grain, b.grain) << x << " " << y;
      ASSERT_FLOAT_EQ(a.pins, b.pins);
      ASSERT_FLOAT_EQ(a.alum, b.alum);
    }
  const Cells other = sample(6, 320, 640);
  EXPECT_FALSE(std::ranges::equal(here, other, {}, &Texture::grain, &Texture::grain));
}

TEST(PaperTexture, StaysWithinItsRangeAndVaries) {
  double least = 1;
  double most = 0;
  for (int row = 0; row < 6; ++row)
    for (const Texture& t : sample(1, 96, row * tile::side)) {
      for (float v : {t.grain, t.pins, t.alum}) {
        ASSERT_GE(v, 0);
        ASSERT_LE(v, 1);
      }
      least = std::min(least, static_cast<double>(t.grain));
      most = std::max(most, static_cast<double>(t.grain));
    }
  EXPECT_LT(least, 0.25);
  EXPECT_GT(most, 0.55);
}

TEST(PaperTexture, AFinerLatticeSeesTheSameFibres) {
  const Cells coarse = sample(9, 64, 64, 0.1);
  std::array<float, tile::cells> fine{};
  for (int part = 0; part < 4; ++part) {
    const int dx = part % 2 * tile::side;
    const int dy = part / 2 * tile::side;
    const Cells quarter = sample(9, 128 + dx, 128 + dy, 0.05);
    for (int y = 0; y < tile::side; ++y)
      for (int x = 0; x < tile::side; ++x)
        fine[static_cast<std::size_t>((dy + y) / 2 * tile::side + (dx + x) / 2)] +=
            0.25F * quarter[static_cast<std::size_t>(y * tile::side + x)].grain;
  }
  double error = 0;
  for (std::size_t i = 0; i < fine.size(); ++i)
    error += std::abs(static_cast<double>(fine[i] - coarse[i].grain));
  EXPECT_LT(error / tile::cells, 0.02);
}

TEST(PaperTexture, ClosesWhatIsOffTheSheet) {
  std::vector<float> block(tile::planes * tile::cells);
  const PlaneView view{block.data(), tile::side, tile::cells};
  PaperTexture(PaperSpec{}, 1, 0.1, 40, 50, true).fill(32, 32, view);
  EXPECT_LE(view.cells(tile::paper_begin + tile::blocking, 17)[7], 1);
  EXPECT_EQ(view.cells(tile::paper_begin + tile::blocking, 17)[8], tile::closed_blocking);
  EXPECT_EQ(view.cells(tile::paper_begin + tile::grain, 18)[0], tile::closed_grain);
}

}  // namespace
}  // namespace fude
