#include "sim/brush/brush_spec.h"

#include <gtest/gtest.h>

namespace fude {
namespace {

TEST(BrushSpec, ReadsWhatIsGivenAndKeepsTheRest) {
  const auto spec = parse_brush_spec("name = 'wolf'\ntuft_length_mm = 40.5\nspread = false\n", "wolf.toml");
  ASSERT_TRUE(spec) << spec.error().message;
  EXPECT_EQ(spec->name, "wolf");
  EXPECT_EQ(spec->tuft_length_mm, 40.5);
  EXPECT_FALSE(spec->spread);
  EXPECT_EQ(spec->taper, BrushSpec{}.taper);
}

TEST(BrushSpec, RefusesWhatItCannotMean) {
  for (const char* bad : {"tuft_length_mm = 'long'", "tuft_length_mm = -1", "tuft_length_mm = nan",
                          "hairs = 3", "segments = 5.5", "spread = 1", "name = 3", "tuft_length_mm = = 2"}) {
    const auto spec = parse_brush_spec(bad, "bad.toml");
    ASSERT_FALSE(spec) << bad;
    EXPECT_EQ(spec.error().fault, Fault::malformed) << bad;
    EXPECT_NE(spec.error().message.find("bad.toml"), std::string::npos) << spec.error().message;
  }
  EXPECT_EQ(read_brush_spec("/nowhere/brush.toml").error().fault, Fault::not_found);
}

TEST(BrushSpec, StandardsLieInTheirRanges) {
  for (const BrushParameter& row : brush_parameters()) {
    EXPECT_GE(row.standard, row.minimum) << row.id;
    EXPECT_LE(row.standard, row.maximum) << row.id;
  }
}

}  // namespace
}  // namespace fude
