#include "capture/import/images.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "capture/import/import.h"
#include "tests/fakes/recordings.h"

namespace fude {
namespace {

// The heads alone: nothing here decodes a picture.
std::string png_of(unsigned char width, unsigned char height) {
  std::string bytes("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0w\0\0\0h\x08\0\0\0\0", 29);
  bytes[19] = static_cast<char>(width);
  bytes[23] = static_cast<char>(height);
  return bytes;
}
const std::string jpeg("\xff\xd8\xff\xe0\0\x04xx\xff\xc0\0\x11\x08\0\x20\0\x40\x03", 18);

class Images : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("fude-images-" + std::to_string(getpid()) + "-" +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& name, const std::string& content) {
    std::ofstream(folder_ / name, std::ios::binary) << content;
  }
  std::filesystem::path folder_;
};

TEST_F(Images, AFolderBecomesFramesInTheOrderOfItsNumbers) {
  write("frame10.png", png_of(10, 11));
  write("frame9.png", png_of(9, 11));
  write("frame9a.jpg", jpeg);
  write("notes.yml", "square: 25\n");
  ImportOptions options;
  options.rate_hz = 4;
  const auto file = import_file(folder_, options);
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->format, ImportFormat::images);
  const RawRecording& recording = file->recordings[0];
  ASSERT_EQ(recording.samples.size(), 3U);
  ASSERT_EQ(recording.transfers.size(), 3U);
  const auto frame = [&](std::size_t i) { return std::get<CameraFrame>(recording.samples[i]); };
  EXPECT_EQ(frame(0).width, 9);
  EXPECT_EQ(frame(1).format, PixelFormat::mjpeg);
  EXPECT_EQ(frame(1).width, 64);
  EXPECT_EQ(frame(1).height, 32);
  EXPECT_EQ(frame(2).width, 10);
  EXPECT_EQ(frame(2).time.sequence, 2U);
  EXPECT_EQ(frame(2).time.host, Timestamp(std::chrono::milliseconds(500)));
  EXPECT_EQ(recording.transfers[1].kind, TransferKind::picture);
  EXPECT_EQ(recording.transfers[1].time, frame(1).time.host);
  EXPECT_EQ(recording.transfers[1].payload.size(), jpeg.size());
  EXPECT_EQ(recording.passed_over.at("files that are no PNG or JPEG"), 1U);
}

TEST_F(Images, APatternTakesWhatItNames) {
  write("a1.png", png_of(1, 1));
  write("b1.png", png_of(2, 2));
  const auto file = import_file(folder_ / "b*.png", {});
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->recordings[0].samples.size(), 1U);
  EXPECT_EQ(import_file(folder_ / "c*.png", {}).error().fault, Fault::not_found);
  EXPECT_EQ(import_file(folder_ / "b1.png", {})->format, ImportFormat::images);
}

TEST_F(Images, PublishedPicturesKeepTheirSize) {
  REQUIRE_RECORDING("camera/opencv_left");
  const auto file = import_file(recordings() / "camera/opencv_left", {});
  ASSERT_TRUE(file) << file.error().message;
  ASSERT_EQ(file->recordings[0].samples.size(), 13U);
  for (const Sample& s : file->recordings[0].samples) {
    EXPECT_EQ(std::get<CameraFrame>(s).width, 640);
    EXPECT_EQ(std::get<CameraFrame>(s).height, 480);
  }
}

}  // namespace
}  // namespace fude
