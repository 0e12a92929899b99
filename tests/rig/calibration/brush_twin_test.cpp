// The twin's files, and what it refuses by name.
#include "rig/calibration/brush_twin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "rig/calibration/twin_trials.h"
#include "sim/optics/png_file.h"
#include "tests/sim/brush/twin_gestures.h"

namespace fude {
namespace {

namespace fs = std::filesystem;

BrushSpec quick_brush() {
  BrushSpec spec;
  spec.name = "quick";
  spec.segments = 3;
  spec.tuft_length_mm = 20;
  spec.longest_step_s = 0.02;
  return spec;
}

std::vector<TwinTrial> trials_of(const BrushSpec& real) {
  std::vector<TwinTrial> trials;
  for (NamedHand& named : twin_gestures(real.tuft_length_mm, 50)) {
    Mark mark = perform(real, named.hand).mark;
    trials.push_back({named.name, std::move(named.hand), std::move(mark)});
  }
  return trials;
}

std::string reason(const BrushSpec& known, const std::vector<TwinTrial>& trials) {
  const BrushTwin twin = twin_of(known, trials, 1, {});
  EXPECT_FALSE(twin.outcome.report.accepted);
  EXPECT_FALSE(twin.outcome.result);
  EXPECT_EQ(twin.spec, known);
  return twin.outcome.report.reason;
}

TEST(BrushTwin, RefusesByTheLikelyCause) {
  const BrushSpec known = quick_brush();
  const std::vector<TwinTrial> trials = trials_of(known);
  EXPECT_NE(reason(known, {trials.begin(), trials.begin() + 3}).find("too few footprints: 3"),
            std::string::npos);
  EXPECT_NE(reason(known, std::vector(6, trials[0])).find("drags"), std::string::npos);

  auto metres = trials;
  for (TwinTrial& trial : metres)
    for (HandMoment& moment : trial.hand) moment.paper_from_handle.translation /= 1000;
  EXPECT_NE(reason(known, metres).find("millimetres"), std::string::npos);

  auto high = trials;
  for (HandMoment& moment : high[2].hand) moment.paper_from_handle.translation.z() += 30;
  EXPECT_NE(reason(known, high).find("pressed: the hair never reaches"), std::string::npos);

  auto inches = trials;
  for (TwinTrial& trial : inches) {
    trial.seen.cell_mm *= 2.54;
    trial.seen.left_mm *= 2.54;
    trial.seen.bottom_mm *= 2.54;
  }
  EXPECT_NE(reason(known, inches).find("mm_per_pixel"), std::string::npos);

  auto elsewhere = trials;
  for (TwinTrial& trial : elsewhere) trial.seen.left_mm += 25;
  EXPECT_NE(reason(known, elsewhere).find("left_mm"), std::string::npos);
}

TEST(BrushTwin, NamesWhatTheGesturesDoNotTell) {
  BrushSpec known = quick_brush();
  known.plasticity = false;  // as stiff hair that keeps no bend: nothing shows how much it would keep
  const std::string why = reason(known, trials_of(known));
  EXPECT_NE(why.find("plasticity_rad"), std::string::npos) << why;
  EXPECT_NE(why.find("touched down"), std::string::npos) << why;
}

TEST(BrushTwin, IsWrittenAsABrush) {
  BrushSpec spec = quick_brush();
  spec.friction_along = 0.2468;
  spec.spread = false;
  const auto again = parse_brush_spec(toml_of(spec, "a remark"), "twin");
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(*again, spec);
}

class TwinFolder : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "fude_twin_XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder = pattern;
    Picture picture(80, 60);
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 80; ++x)
        picture.row(y)[static_cast<std::size_t>(x)].fill(x >= 30 && x < 50 && y >= 10 && y < 20 ? 0x2000
                                                                                                : 0xe000);
    ASSERT_TRUE(write_png(folder / "mark.png", picture, {.depth = 8}));
    write("hand.csv", moments(20));
    write("trials.toml", trial);
  }
  void TearDown() override { fs::remove_all(folder); }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder / name) << text; }
  static std::string moments(int count) {
    std::string text = "t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,force_n\n";
    for (int i = 0; i < count; ++i) text += std::to_string(0.01 * i) + ",1,2,15,1,0,0,0,0.25 # held\n";
    return text;
  }
  std::string wrong() {
    const auto trials = read_twin_trials(folder);
    EXPECT_FALSE(trials);
    return trials ? "" : trials.error().message;
  }
  const std::string trial =
      "[[trial]]\npicture = \"mark.png\"\nhand = \"hand.csv\"\nmm_per_pixel = 0.1\nleft_mm = -2\nbottom_mm = "
      "3\n";
  fs::path folder;
};

TEST_F(TwinFolder, IsRead) {
  const auto trials = read_twin_trials(folder);
  ASSERT_TRUE(trials) << trials.error().message;
  ASSERT_EQ(trials->size(), 1U);
  const TwinTrial& one = trials->front();
  EXPECT_EQ(one.name, "mark");
  ASSERT_EQ(one.hand.size(), 20U);
  EXPECT_EQ(one.hand[3].paper_from_handle.translation, Eigen::Vector3d(1, 2, 15));
  EXPECT_EQ(one.hand[3].force_mn, 250);
  // Ink from 1 to 3 mm right and from 4 to 5 mm up in the picture.
  EXPECT_NEAR(one.seen.area_mm2(), 2, 1e-6);
  EXPECT_EQ(one.seen.at({2, 7.5}), 1);
  EXPECT_EQ(one.seen.at({0, 5}), 0);
}

TEST_F(TwinFolder, SaysWhatIsWrong) {
  write("hand.csv", moments(4));
  EXPECT_NE(wrong().find("fewer than ten"), std::string::npos);
  write("hand.csv", moments(12) + "0.02,1,2,15,1,0,0,0\n");
  EXPECT_NE(wrong().find("line 14: time runs backwards"), std::string::npos);
  write("hand.csv", "0,1,2,15,1,1,0,0\n");
  EXPECT_NE(wrong().find("no rotation"), std::string::npos);
  write("hand.csv", "0,1,2,nan,1,0,0,0\n");
  EXPECT_NE(wrong().find("line 1"), std::string::npos);
  write("hand.csv", moments(12));
  write("trials.toml", "[[trial]]\npicture = \"mark.png\"\nhand = \"hand.csv\"\nmm_per_pixel = 0.1\n");
  EXPECT_NE(wrong().find("left_mm"), std::string::npos);
  write("trials.toml", "nothing = 1\n");
  EXPECT_NE(wrong().find("[[trial]]"), std::string::npos);
  write("trials.toml", trial);
  write("mark.png", "no picture");
  EXPECT_NE(wrong().find("no PNG"), std::string::npos);
  fs::remove(folder / "trials.toml");
  EXPECT_NE(wrong().find("trials.toml"), std::string::npos);
}

TEST_F(TwinFolder, PicturesWithoutAMarkOrCutOffAreNamed) {
  const GreyImage blank{50, 50, std::vector<std::uint8_t>(2500, 220)};
  EXPECT_NE(mark_in(blank, 0.1, 0, 0, "p").error().message.find("no mark"), std::string::npos);
  GreyImage cut = blank;
  for (std::size_t i = 0; i < 400; ++i) cut.pixels[i] = 10;  // the upper rows
  EXPECT_NE(mark_in(cut, 0.1, 0, 0, "p").error().message.find("runs out"), std::string::npos);
}

}  // namespace
}  // namespace fude
