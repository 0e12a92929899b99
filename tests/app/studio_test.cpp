// The studio's window on a display of its own (Xvfb): painted in by injected events, its pixels looked at,
// and its recording painted again.
#include <gtest/gtest.h>
#include <png.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "app/studio/care_choice.h"
#include "app/studio/mouse_pen.h"
#include "app/studio/script.h"
#include "app/studio/view.h"

namespace fude {
namespace {

TEST(StudioScript, ReadsEventsInOrder) {
  const auto events =
      read_script("# a stroke\n0.5 move 10 20.5\n\n0.6 press # down\n0.7 save my file.png\n1 quit\n", "s");
  ASSERT_TRUE(events) << events.error().message;
  ASSERT_EQ(events->size(), 4U);
  EXPECT_EQ((*events)[0].at_s, 0.5);
  EXPECT_EQ(std::get<MoveTo>((*events)[0].what).y_mm, 20.5);
  EXPECT_TRUE(std::get<Button>((*events)[1].what).pressed);
  EXPECT_EQ(std::get<SaveAs>((*events)[2].what).file, "my file.png");
  EXPECT_TRUE(std::holds_alternative<Quit>((*events)[3].what));
}

TEST(StudioScript, NamesTheLineThatIsWrong) {
  for (const char* wrong :
       {"0.1 press\nsoon press\n", "0.1 press\n0.2 dance\n", "0.1 press\n0.2 move 3\n",
        "0.1 press\n0.05 release\n", "0.1 press\n0.2 look pretty\n", "0.1 press\n0.2 pressure 2\n",
        "0.1 press\n0.2 key jump\n", "0.1 press\n0.2 press hard\n", "0.1 press\nnan release\n"}) {
    const auto events = read_script(wrong, "s.txt");
    ASSERT_FALSE(events) << wrong;
    EXPECT_NE(events.error().message.find("s.txt, line 2"), std::string::npos) << events.error().message;
  }
}

TEST(StudioView, KeepsThePaperUnderThePointerWhileZooming) {
  View view;
  view.window = {1000, 800};
  view.fit({210, 148});
  const Eigen::Vector2d pointer(300, 200);
  const Eigen::Vector2d held = view.to_paper(pointer);
  view.zoom(3, pointer);
  EXPECT_LT((view.to_paper(pointer) - held).norm(), 1e-9);
  EXPECT_LT((view.to_window(view.to_paper(pointer)) - pointer).norm(), 1e-9);
  EXPECT_GT(view.to_paper({0, 0}).y(), view.to_paper({0, 10}).y());
  view.pan({15, -7});
  EXPECT_LT((view.to_window(held) - (pointer + Eigen::Vector2d(15, -7))).norm(), 1e-9);
}

TEST(MousePen, IsATabletAsLargeAsTheSheet) {
  const Extent sheet{Millimetres(120), Millimetres(80)};
  const DeviceDescription mouse = mouse_description(sheet);
  EXPECT_EQ(mouse.kind, DeviceKind::mouse);
  const TabletMapping mapping = mapping_for(mouse, sheet).value();
  MousePen pen{.sheet = sheet, .over_paper = true, .pressed = true, .pressure = 0.4, .at_mm = {30, 70}};
  const PenSample sample = pen.sample({});
  EXPECT_TRUE(sample.in_contact);
  EXPECT_EQ(sample.pressure.value, 0.4);
  EXPECT_LT((nib_on_paper(sample, mapping) - pen.at_mm).norm(), 1e-9);
  pen.over_paper = false;
  EXPECT_EQ(pen.sample({}).tool, PenTool::none);
}

TEST(StudioKeys, CareForTheBrushWithTheChosenColour) {
  const CareChoice choice{.pigment = 1, .strength = 2, .glue = 0.1F, .wetness = 0.5F, .depth_mm = 6};
  const Concentrations colour{0, 2, 0, 0.1F};
  EXPECT_EQ(care_for(StudioKey::load, choice), BrushCare(LoadBrush{0.5F, colour}));
  EXPECT_EQ(care_for(StudioKey::dip, choice), BrushCare(DipBrush{6, 0.5F, colour}));
  const auto ramps = std::get<GradeBrush>(care_for(StudioKey::gradient, choice).value());
  EXPECT_EQ(ramps.side.back().strength, colour);
  EXPECT_LT(ramps.side.front().strength[1], 0.5F);
  for (const StudioKey key : {StudioKey::rinse, StudioKey::wipe, StudioKey::blot, StudioKey::roll})
    EXPECT_TRUE(care_for(key, choice));
  EXPECT_FALSE(care_for(StudioKey::undo, choice));
}

struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> grey;
  int at(int x, int y) const { return grey[static_cast<std::size_t>(y * width + x)]; }
  int darkest(int left, int top, int right, int bottom) const {
    int least = 255;
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x) least = std::min(least, at(x, y));
    return least;
  }
};

Image read(const std::filesystem::path& file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  Image image;
  if (!png_image_begin_read_from_file(&png, file.c_str())) return image;
  png.format = PNG_FORMAT_GRAY;
  image.width = static_cast<int>(png.width);
  image.height = static_cast<int>(png.height);
  image.grey.resize(PNG_IMAGE_SIZE(png));
  png_image_finish_read(&png, nullptr, image.grey.data(), 0, nullptr);
  return image;
}

int run(const std::string& command) { return std::system(command.c_str()); }

TEST(StudioWindow, PaintsUndoesAndRecordsWhatAReplayPaintsAgain) {
  std::string pattern = testing::TempDir() + "fude_studio_XXXXXX";
  ASSERT_NE(mkdtemp(pattern.data()), nullptr);
  const std::filesystem::path folder = pattern;
  // Two bars on a sheet of 80 × 60 mm; the second is taken back.
  {
    std::ofstream script(folder / "script");
    double t = 0.3;
    for (const double y : {45.0, 20.0}) {
      script << t << " move 15 " << y << "\n" << t + 0.02 << " press\n";
      t += 0.03;
      for (int i = 0; i <= 60; ++i, t += 0.01) script << t << " move " << 15 + 0.8 * i << " " << y << "\n";
      script << t << " release\n" << t + 0.05 << " move 70 55\n";
      t += 0.1;
    }
    script << t + 0.6 << " save " << (folder / "both.png").string() << "\n"
           << t + 0.6 << " shot " << (folder / "window.png").string() << "\n"
           << t + 0.65 << " key rinse\n"
           << t + 0.66 << " key wipe\n"
           << t + 0.67 << " key dip\n"
           << t + 0.70 << " key undo\n"
           << t + 0.72 << " key undo\n"
           << t + 0.74 << " key undo\n"
           << t + 0.76 << " key undo\n"
           << t + 2.2 << " save " << (folder / "undone.png").string() << "\n"
           << t + 2.3 << " quit\n";
  }
  const std::string fude = FUDE_PROGRAM;
  const std::string in = "cd " + folder.string() + " && ";
  ASSERT_EQ(run(in + "xvfb-run -a -s '-screen 0 1280x960x24' " + fude +
                " paint --script script --size-mm 80x60 --paper branching --backend cpu --out live.fude "
                "--picture end.png"),
            0);
  const Image both = read(folder / "both.png");
  ASSERT_EQ(both.width, 800);
  ASSERT_EQ(both.height, 600);
  EXPECT_LT(both.darkest(200, 120, 600, 180), 100);
  EXPECT_LT(both.darkest(200, 370, 600, 430), 100);
  EXPECT_GT(both.darkest(20, 500, 780, 590), 200);

  // The sheet stands fitted in the window: the same bars, and the paper between them.
  const Image window = read(folder / "window.png");
  ASSERT_GT(window.width, 600);
  View view;
  view.window = {window.width, window.height};
  view.fit({80, 60});
  const auto darkest_at = [&](double x_mm, double y_mm, double half_mm) {
    const Eigen::Vector2d low = view.to_window({x_mm - half_mm, y_mm + half_mm});
    const Eigen::Vector2d high = view.to_window({x_mm + half_mm, y_mm - half_mm});
    return window.darkest(static_cast<int>(low.x()), static_cast<int>(low.y()), static_cast<int>(high.x()),
                          static_cast<int>(high.y()));
  };
  EXPECT_LT(darkest_at(45, 45, 3), 100);
  EXPECT_LT(darkest_at(45, 20, 3), 100);
  EXPECT_GT(darkest_at(45, 6, 1), 200);

  const Image undone = read(folder / "undone.png");
  ASSERT_EQ(undone.width, 800);
  EXPECT_LT(undone.darkest(200, 120, 600, 180), 100);
  EXPECT_GT(undone.darkest(200, 370, 600, 430), 200);

  // On the paper that the session names, unless another is asked for.
  ASSERT_EQ(run(in + fude + " replay live.fude --out replay.png"), 0);
  EXPECT_EQ(run(in + "cmp end.png replay.png"), 0);
  ASSERT_EQ(run(in + fude + " replay live.fude --paper xuan --out other.png"), 0);
  EXPECT_NE(run(in + "cmp -s end.png other.png"), 0);
  std::filesystem::remove_all(folder);
}

TEST(StudioWindow, TheBrushIsSeenAsAskedAndTheStrokeThroughIt) {
  std::string pattern = testing::TempDir() + "fude_look_XXXXXX";
  ASSERT_NE(mkdtemp(pattern.data()), nullptr);
  const std::filesystem::path folder = pattern;
  // A bar, and the brush held over it.
  {
    std::ofstream script(folder / "script");
    double t = 0.3;
    script << t << " move 15 32\n" << t + 0.02 << " press\n";
    t += 0.03;
    for (int i = 0; i <= 60; ++i, t += 0.01) script << t << " move " << 15 + 0.6 * i << " 32\n";
    script << t << " release\n" << t + 0.05 << " move 70 50\n" << t + 0.1 << " move 35 30\n";
    t += 0.8;
    for (const char* look : {"off", "shaded", "colours", "outline", "development"}) {
      script << t << " look " << look << "\n"
             << t + 0.3 << " shot " << (folder / (std::string(look) + ".png")).string() << "\n";
      t += 0.4;
    }
    script << t << " quit\n";
  }
  ASSERT_EQ(run("cd " + folder.string() + " && xvfb-run -a -s '-screen 0 1280x960x24' " + FUDE_PROGRAM +
                " paint --script script --size-mm 80x60 --backend cpu --flow off"),
            0);
  const Image off = read(folder / "off.png");
  ASSERT_GT(off.width, 600);
  const auto changed = [&](const char* look, auto take) {
    const Image seen = read(folder / (std::string(look) + ".png"));
    ASSERT_EQ(seen.width, off.width);
    // Right of the panel.
    for (int y = 0; y < off.height; ++y)
      for (int x = 300; x < off.width; ++x)
        if (std::abs(seen.at(x, y) - off.at(x, y)) > 4) take(off.at(x, y), seen.at(x, y));
  };
  double through = 0;
  double beside = 0;
  int over_ink = 0;
  int over_paper = 0;
  changed("shaded", [&](int bare, int seen) {
    if (bare < 60) through += seen, ++over_ink;
    if (bare > 200 && seen < 190) beside += seen, ++over_paper;
  });
  ASSERT_GT(over_ink, 300);
  ASSERT_GT(over_paper, 1000);
  EXPECT_LT(through / over_ink, beside / over_paper - 10);
  int rim = 0;
  int hair = 0;
  changed("outline", [&](int bare, int seen) { rim += bare - seen > 100; });
  changed("colours", [&](int bare, int seen) { hair += bare - seen > 100; });
  EXPECT_GT(rim, 100);
  EXPECT_GT(hair, 5 * rim);
  int skeleton = 0;
  changed("development", [&](int, int) { ++skeleton; });
  int outline = 0;
  changed("outline", [&](int, int) { ++outline; });
  EXPECT_GT(skeleton, outline + 200);
  std::filesystem::remove_all(folder);
}

TEST(StudioWindow, SaysWhatToDoWithoutADisplay) {
  const std::string log = testing::TempDir() + "fude_no_display_" + std::to_string(getpid());
  const int status =
      run("env -u DISPLAY -u WAYLAND_DISPLAY " + std::string(FUDE_PROGRAM) + " paint 2>" + log);
  EXPECT_EQ(WEXITSTATUS(status), 1);
  std::ifstream in(log);
  std::string line;
  std::getline(in, line);
  EXPECT_NE(line.find("fude replay"), std::string::npos) << line;
  EXPECT_FALSE(std::getline(in, line)) << line;
  std::filesystem::remove(log);
}

}  // namespace
}  // namespace fude
