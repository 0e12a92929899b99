#include "sim/optics/png_file.h"

#include <gtest/gtest.h>
#include <png.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <fstream>

namespace fude {
namespace {

class PngFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "fude_png_XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder = pattern;
    file = folder / "picture.png";
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::ptrdiff_t files() const {
    return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
  }

  std::filesystem::path folder;
  std::filesystem::path file;
};

Picture gradient(int width, int height) {
  Picture picture(width, height);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    picture.pixels[i] = {static_cast<std::uint16_t>(i * 37), static_cast<std::uint16_t>(i * 1009 + 5),
                         static_cast<std::uint16_t>(65535 - i)};
  return picture;
}

struct ReadBack {
  int depth = 0;
  int colour_type = 0;
  int intent = -1;
  Picture picture;
};

ReadBack read(const std::filesystem::path& path) {
  ReadBack back;
  std::FILE* stream = std::fopen(path.c_str(), "rb");
  if (!stream) return back;
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop header = png_create_info_struct(png);
  png_init_io(png, stream);
  png_read_png(png, header, PNG_TRANSFORM_IDENTITY, nullptr);
  back.depth = png_get_bit_depth(png, header);
  back.colour_type = png_get_color_type(png, header);
  png_get_sRGB(png, header, &back.intent);
  back.picture = Picture(static_cast<int>(png_get_image_width(png, header)),
                         static_cast<int>(png_get_image_height(png, header)));
  png_bytepp rows = png_get_rows(png, header);
  for (int y = 0; y < back.picture.height; ++y) {
    const png_byte* at = rows[y];
    for (Rgb16& pixel : back.picture.row(y))
      for (std::uint16_t& value : pixel) {
        value = back.depth == 16 ? static_cast<std::uint16_t>(at[0] << 8 | at[1]) : at[0];
        at += back.depth / 8;
      }
  }
  png_destroy_read_struct(&png, &header, nullptr);
  std::fclose(stream);
  return back;
}

TEST_F(PngFile, KeepsEveryBitOfSixteen) {
  const Picture picture = gradient(53, 31);
  ASSERT_TRUE(write_png(file, picture));
  const ReadBack back = read(file);
  EXPECT_EQ(back.depth, 16);
  EXPECT_EQ(back.colour_type, PNG_COLOR_TYPE_RGB);
  EXPECT_EQ(back.intent, PNG_sRGB_INTENT_PERCEPTUAL);
  EXPECT_EQ(back.picture.width, 53);
  EXPECT_EQ(back.picture.pixels, picture.pixels);
}

TEST_F(PngFile, RoundsToEightBits) {
  const Picture picture = gradient(256, 256);
  ASSERT_TRUE(write_png(file, picture, {.depth = 8}));
  const ReadBack back = read(file);
  ASSERT_EQ(back.depth, 8);
  EXPECT_EQ(back.intent, PNG_sRGB_INTENT_PERCEPTUAL);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    for (std::size_t band = 0; band < 3; ++band)
      ASSERT_LE(std::abs(picture.pixels[i][band] - 257 * back.picture.pixels[i][band]), 128);
}

TEST_F(PngFile, IsReadableAsTheUserAsked) {
  const mode_t before = umask(027);
  ASSERT_TRUE(write_png(file, gradient(2, 2)));
  umask(before);
  struct stat status;
  ASSERT_EQ(stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
}

TEST_F(PngFile, ReplacesNothingUnlessTold) {
  ASSERT_TRUE(write_png(file, gradient(4, 4)));
  const auto refused = write_png(file, gradient(8, 8));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().fault, Fault::exists);
  EXPECT_NE(refused.error().message.find("--force"), std::string::npos);
  EXPECT_EQ(read(file).picture.width, 4);
  ASSERT_TRUE(write_png(file, gradient(8, 8), {.overwrite = true}));
  EXPECT_EQ(read(file).picture.width, 8);
  EXPECT_EQ(files(), 1);
}

TEST_F(PngFile, LeavesTheOldFileWhenWritingFails) {
  ASSERT_TRUE(write_png(file, gradient(4, 4)));
  // A limit on the size of files stands in for a full disk.
  rlimit before;
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit tight = before;
  tight.rlim_cur = 20000;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &tight);
  const auto refused = write_png(file, gradient(500, 500), {.overwrite = true});
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().fault, Fault::storage);
  EXPECT_EQ(read(file).picture.width, 4);
  EXPECT_EQ(files(), 1);
}

TEST_F(PngFile, SaysWhatToDoAboutABadPlace) {
  const auto nowhere = write_png(folder / "no" / "where.png", gradient(2, 2));
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().fault, Fault::not_found);
  std::ofstream(folder / "plain") << "x";
  const auto inside_a_file = write_png(folder / "plain" / "x.png", gradient(2, 2));
  ASSERT_FALSE(inside_a_file);
  EXPECT_EQ(inside_a_file.error().fault, Fault::not_found);
}

TEST_F(PngFile, RefusesWhatIsNoPicture) {
  EXPECT_EQ(write_png(file, Picture()).error().fault, Fault::usage);
  EXPECT_EQ(write_png(file, gradient(2, 2), {.depth = 12}).error().fault, Fault::usage);
  EXPECT_EQ(write_png(file, Picture(1'000'001, 1)).error().fault, Fault::usage);
  EXPECT_EQ(files(), 0);
}

TEST_F(PngFile, ADeviceNodeIsNeverReplaced) {
  const auto refused = write_png("/dev/null", gradient(2, 2), {.overwrite = true});
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().fault, Fault::no_access);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

}  // namespace
}  // namespace fude
