#include "sim/optics/colour.h"

#include <gtest/gtest.h>

#include <set>

#include "sim/optics/kubelka_munk.h"
#include "sim/optics/srgb.h"

namespace fude {
namespace {

const Palette sumi{{pigments()[0]}};

double luminance(const Bands& linear) { return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]; }

TEST(Pigments, HaveDistinctNamesAndPossibleCoefficients) {
  std::set<std::string_view> names;
  for (const Pigment& row : pigments()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_EQ(find_pigment(row.name)->name, row.name);
    for (std::size_t band = 0; band < 3; ++band) {
      EXPECT_GT(row.absorption[band], 0) << row.name;
      EXPECT_GT(row.scattering[band], 0) << row.name;
    }
  }
  EXPECT_EQ(pigments()[0].name, "sumi");
  EXPECT_EQ(pigments().size(), 13u);
}

TEST(Pigments, AnUnknownNameListsTheKnownOnes) {
  const auto found = find_pigment("mauve");
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().message.find("sumi, quinacridone-rose"), std::string::npos)
      << found.error().message;
}

TEST(Colour, BarePaperIsThePaper) {
  const Bands seen = colour({}, sumi);
  for (std::size_t band = 0; band < 3; ++band) EXPECT_DOUBLE_EQ(seen[band], xuan_reflectance[band]);
}

TEST(Colour, GlueIsNotSeen) { EXPECT_EQ(colour({0.02f, 0, 0, 0}, sumi), colour({0.02f, 0, 0, 0.5f}, sumi)); }

TEST(Colour, InkDarkensSteadilyTowardsAWarmBlack) {
  double before = luminance(colour({}, sumi));
  for (float amount = 0.005f; amount < 0.3f; amount += 0.005f) {
    const double now = luminance(colour({amount, 0, 0, 0}, sumi));
    EXPECT_LT(now, before);
    before = now;
  }
  const Bands unit = colour({0.1f, 0, 0, 0}, sumi);
  EXPECT_LT(luminance(unit), 0.01);
  const Bands wash = colour({0.01f, 0, 0, 0}, sumi);
  EXPECT_NEAR(luminance(wash), 0.33, 0.03);
  EXPECT_GT(wash[0] / xuan_reflectance[0], wash[2] / xuan_reflectance[2]);
  EXPECT_LT(wash[0] / xuan_reflectance[0] - wash[2] / xuan_reflectance[2], 0.05);
}

TEST(Colour, AMixtureAddsTheCoefficientsOfItsPigments) {
  const Palette both{{*find_pigment("french-ultramarine"), *find_pigment("hansa-yellow")}};
  const Bands seen = colour({0.05f, 0.2f, 0, 0}, both);
  const double blue_layers = static_cast<double>(0.05f) / 0.1;
  const double yellow_layers = static_cast<double>(0.2f) / 0.1;
  const LayerOptics green =
      layer_optics(0.86 * blue_layers + 0.21 * yellow_layers, 0.005 * blue_layers + 0.88 * yellow_layers);
  EXPECT_NEAR(seen[1], reflectance_over(green, xuan_reflectance[1]), 1e-12);
}

TEST(ColourRow, GivesEachCellItsOwnRoundedColour) {
  std::vector<Concentrations> cells(64);
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i][0] = static_cast<float>((i / 3) % 7) * 0.01f;
  std::vector<Rgb16> row(cells.size());
  colour_row(cells, sumi, row);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Bands seen = colour(cells[i], sumi);
    for (std::size_t band = 0; band < 3; ++band)
      EXPECT_NEAR(row[i][band], srgb_from_linear(seen[band]) * 65535, 0.5 + 1e-9) << i;
  }
}

TEST(ColourRow, RefusesWhatDoesNotFit) {
  std::vector<Concentrations> cells(2);
  std::vector<Rgb16> row(3);
  EXPECT_THROW(colour_row(cells, sumi, row), std::invalid_argument);
  row.resize(2);
  EXPECT_THROW(colour_row(cells, Palette{{pigments().begin(), pigments().begin() + 4}}, row),
               std::invalid_argument);
}

}  // namespace
}  // namespace fude
