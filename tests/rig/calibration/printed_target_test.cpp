// The printed board is the one that the camera's calibration looks for, at true scale in both kinds of file.
#include "rig/calibration/printed_target.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "capture/picture/grey_picture.h"
#include "vision/board.h"

namespace fude {
namespace {

const Board chessboard{};
const Board charuco{.kind = BoardKind::charuco,
                    .columns = 7,
                    .rows = 9,
                    .square_m = 0.02,
                    .marker_m = 0.015,
                    .dictionary = "DICT_4X4_250"};

// A picture made smaller by whole numbers, each pixel the mean of what it was.
GreyImage thinned(const GreyImage& image, int times) {
  GreyImage small{image.width / times, image.height / times, {}};
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      int sum = 0;
      for (int v = 0; v < times; ++v)
        for (int u = 0; u < times; ++u)
          sum +=
              image
                  .pixels[std::size_t(y * times + v) * std::size_t(image.width) + std::size_t(x * times + u)];
      small.pixels.push_back(static_cast<std::uint8_t>(sum / (times * times)));
    }
  return small;
}

// The farthest that the distance of two corners is from what the board says, over the whole board.
double scale_error_mm(const GreyImage& image, const Board& board, double pixels_per_mm) {
  const auto view = find_board(image, board);
  if (!view) return 1e9;
  EXPECT_EQ(int(view->corners.size()), corners_of(board));
  double worst = 0;
  for (std::size_t i = 1; i < view->corners.size(); ++i) {
    const double seen = (view->pixels[i] - view->pixels[0]).norm() / pixels_per_mm;
    const double meant =
        1e3 * (corner_place_m(board, view->corners[i]) - corner_place_m(board, view->corners[0])).norm();
    worst = std::max(worst, std::abs(seen - meant));
  }
  return worst;
}

PrintedPage page_of(const Board& board, const std::string& page = "a4") {
  const auto printed = printed_target(board, page);
  EXPECT_TRUE(printed) << printed.error().message;
  return printed ? *printed : PrintedPage{};
}

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

TEST(PrintedTarget, ThePngIsTheBoardAtTrueScale) {
  for (const Board& board : {chessboard, charuco}) {
    const auto png = png_of(page_of(board));
    ASSERT_TRUE(png);
    const std::size_t scale = png->find("pHYs");
    ASSERT_NE(scale, std::string::npos);
    EXPECT_EQ(big_endian(*png, scale + 4), 20000U);  // pixels a metre
    EXPECT_EQ(big_endian(*png, scale + 8), 20000U);
    EXPECT_EQ((*png)[scale + 12], 1);
    const CameraFrame frame{.format = PixelFormat::png,
                            .width = std::int32_t(big_endian(*png, 16)),
                            .height = std::int32_t(big_endian(*png, 20))};
    const auto image = grey_picture(std::as_bytes(std::span(*png)), frame);
    ASSERT_TRUE(image) << image.error().message;
    const double error_mm = scale_error_mm(thinned(*image, 4), board, 5);
    std::printf("figure: printed %s, PNG: scale within %.3f mm\n",
                board.kind == BoardKind::charuco ? "ChArUco" : "chessboard", error_mm);
    EXPECT_LT(error_mm, 0.1);
  }
}

// What `pdf` fills, read back from its own operators, in millimetres.
std::vector<PrintedArea> filled(const std::string& pdf) {
  std::vector<PrintedArea> areas;
  std::istringstream lines(pdf.substr(pdf.find("stream\n") + 7));
  double points_per_mm = 0, flipped = 0, height = 0, zero = 0;
  lines >> points_per_mm >> zero >> zero >> flipped >> zero >> height;
  EXPECT_NEAR(points_per_mm, 72 / 25.4, 1e-4);
  EXPECT_EQ(flipped, -points_per_mm);
  std::string line;
  while (std::getline(lines, line) && line != "f") {
    PrintedArea area;
    std::string word;
    std::istringstream words(line);
    if (words >> area.corner_mm.x() >> area.corner_mm.y() >> area.size_mm.x() >> area.size_mm.y() >> word &&
        word == "re")
      areas.push_back(area);
  }
  return areas;
}

TEST(PrintedTarget, ThePdfFillsWhatThePageSays) {
  const PrintedPage page = page_of(charuco);
  const std::string pdf = pdf_of(page);
  const auto areas = filled(pdf);
  ASSERT_EQ(areas.size(), page.black.size());
  for (std::size_t i = 0; i < areas.size(); ++i) {
    EXPECT_LT((areas[i].corner_mm - page.black[i].corner_mm).norm(), 1e-3);
    EXPECT_LT((areas[i].size_mm - page.black[i].size_mm).norm(), 1e-3);
  }
  EXPECT_NE(pdf.find("/MediaBox [0 0 595.2756 841.8898 ]"), std::string::npos);
  // The table of places points at the objects.
  const std::size_t table = std::stoul(pdf.substr(pdf.rfind("startxref\n") + 10));
  EXPECT_EQ(pdf.substr(table, 4), "xref");
  EXPECT_EQ(pdf.substr(std::stoul(pdf.substr(table + 9 + 20, 10)), 7), "1 0 obj");
}

TEST(PrintedTarget, ThePdfRenderedByPopplerIsTheBoard) {
  ASSERT_EQ(std::system("pdftoppm -v >/dev/null 2>&1"), 0) << "poppler-utils is missing";
  const auto folder = std::filesystem::path(testing::TempDir()) / ("fude-target-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  for (const Board& board : {chessboard, charuco}) {
    std::ofstream(folder / "board.pdf", std::ios::binary) << pdf_of(page_of(board));
    const std::string render = "pdftoppm -r 127 -gray -singlefile '" + (folder / "board.pdf").string() +
                               "' '" + (folder / "board").string() + "'";
    ASSERT_EQ(std::system(render.c_str()), 0);
    std::ifstream file(folder / "board.pgm", std::ios::binary);
    std::string kind;
    GreyImage image;
    int most = 0;
    file >> kind >> image.width >> image.height >> most;
    file.get();
    image.pixels.assign(std::istreambuf_iterator<char>(file), {});
    ASSERT_EQ(image.pixels.size(), std::size_t(image.width) * std::size_t(image.height));
    const double error_mm = scale_error_mm(image, board, 127 / 25.4);
    std::printf("figure: printed %s, PDF by poppler: scale within %.3f mm\n",
                board.kind == BoardKind::charuco ? "ChArUco" : "chessboard", error_mm);
    EXPECT_LT(error_mm, 0.1);
  }
  std::filesystem::remove_all(folder);
}

TEST(PrintedTarget, NothingIsPrintedWhereAPrinterDoesNotReach) {
  for (const char* name : {"a4", "a3", "letter"}) {
    const PrintedPage page = page_of(charuco, name);
    for (const PrintedArea& area : page.black) {
      EXPECT_GE(area.corner_mm.minCoeff(), 7.9);
      EXPECT_GE((page.size_mm - area.corner_mm - area.size_mm).minCoeff(), 7.9);
    }
  }
}

TEST(PrintedTarget, ABoardThatDoesNotFitIsRefusedWithWhatWould) {
  const auto large = printed_target({.columns = 9, .rows = 6, .square_m = 0.04}, "a4");
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().fault, Fault::usage);
  EXPECT_NE(large.error().message.find("squares may be"), std::string::npos) << large.error().message;
  const double fits = std::stod(large.error().message.substr(large.error().message.find("may be ") + 7));
  EXPECT_TRUE(printed_target({.columns = 9, .rows = 6, .square_m = 1e-3 * fits}, "a4"));
  EXPECT_FALSE(printed_target({.columns = 9, .rows = 6, .square_m = 1e-3 * (fits + 0.2)}, "a4"));
  EXPECT_TRUE(printed_target({.columns = 9, .rows = 6, .square_m = 0.038}, "a3"));
  EXPECT_FALSE(printed_target(chessboard, "a5"));
  EXPECT_FALSE(printed_target({.columns = 0}, "a4"));
}

TEST(Lettering, KnowsEveryWordOfThePage) {
  for (const char letter : std::string("0123456789ABCDEFGHIKLMNOPQRSTUVWXY.-_"))
    EXPECT_FALSE(lettering(std::string(1, letter), {0, 0}, 7).empty()) << letter;
  const auto one = lettering("I", {10, 20}, 7);
  EXPECT_EQ(one.front().corner_mm, Eigen::Vector2d(11, 20));
  EXPECT_EQ(one.front().size_mm, Eigen::Vector2d(3, 1));
}

}  // namespace
}  // namespace fude
