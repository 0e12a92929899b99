// A camera's pictures as files: what was kept comes out again, and an import of the files gives the same.
#include "capture/export/picture_export.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

#include "capture/import/import.h"
#include "capture/picture/picture_jpeg.h"
#include "capture/picture/picture_png.h"

namespace fude {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::byte>;

constexpr std::int32_t width = 16, height = 9;

Bytes noise(unsigned seed, std::size_t count) {
  std::mt19937 random(seed);
  Bytes bytes(count);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  return bytes;
}

Bytes read_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

void nothing(double) {}

class PictureExport : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    session_.devices.push_back({1, {.name = "camera", .kind = DeviceKind::camera}});
  }
  void TearDown() override { fs::remove_all(folder_); }

  void add(std::chrono::nanoseconds time, std::uint64_t sequence, PixelFormat format,
           const std::optional<Bytes>& bytes) {
    CameraFrame frame{.time = {.host = Timestamp(time), .sequence = sequence}, .format = format};
    frame.width = width;
    frame.height = height;
    session_.samples.push_back({1, frame, 0});
    if (bytes)
      session_.transfers.push_back(
          {1, {.time = Timestamp(time), .kind = TransferKind::picture, .payload = *bytes}});
  }
  Result<PicturesWritten> write(bool overwrite = false) {
    return write_pictures(session_, find_stream(session_, "camera").value(), folder_, overwrite, nothing);
  }

  Session session_;
  fs::path folder_ =
      fs::path(testing::TempDir()) /
      ("pictures_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(PictureExport, GivesBackWhatWasKeptAndImportsAgain) {
  using namespace std::chrono_literals;
  const Bytes grey = noise(1, width * height), yuyv = noise(2, 2 * width * height);
  const Bytes jpeg = raw_to_jpeg(grey, PixelFormat::grey, width, height).value();
  const Bytes png = raw_to_png(yuyv, PixelFormat::yuyv, width, height).value();
  add(9s + 999'999'999ns, 7, PixelFormat::mjpeg, jpeg);
  add(10s + 33ms, 8, PixelFormat::png, png);
  add(10s + 66ms, 9, PixelFormat::grey, grey);
  add(10s + 100ms, 11, PixelFormat::yuyv, yuyv);
  const auto done = write();
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->written, 4U);
  EXPECT_EQ(read_file(folder_ / "09.999999999_000007.jpg"), jpeg);
  EXPECT_EQ(read_file(folder_ / "10.033000000_000008.png"), png);
  EXPECT_EQ(raw_from_png(read_file(folder_ / "10.066000000_000009.png"))->bytes, grey);
  EXPECT_EQ(raw_from_png(read_file(folder_ / "10.100000000_000011.png"))->bytes, yuyv);

  const auto again = import_file(folder_, {.format = ImportFormat::images});
  ASSERT_TRUE(again) << again.error().message;
  const RawRecording& recording = again->recordings[0];
  ASSERT_EQ(recording.transfers.size(), 4U);
  EXPECT_EQ(recording.transfers[0].payload, jpeg);
  EXPECT_EQ(recording.transfers[1].payload, png);
  EXPECT_EQ(raw_from_png(recording.transfers[2].payload)->bytes, grey);
  EXPECT_EQ(raw_from_png(recording.transfers[3].payload)->bytes, yuyv);
  EXPECT_EQ(std::get<CameraFrame>(recording.samples[3]).width, width);
}

TEST_F(PictureExport, WritesOverNothingUnlessTold) {
  const Bytes grey = noise(1, width * height);
  for (int i = 0; i < 3; ++i)
    add(std::chrono::seconds(i), static_cast<std::uint64_t>(i), PixelFormat::grey, grey);
  fs::create_directories(folder_);
  const fs::path second = folder_ / "1.000000000_000001.png";
  std::ofstream(second) << "mine";
  const auto refused = write();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().fault, Fault::exists);
  EXPECT_NE(refused.error().message.find(second.filename().string()), std::string::npos);
  EXPECT_EQ(read_file(second).size(), 4U);
  EXPECT_FALSE(fs::exists(folder_ / "0.000000000_000000.png"));
  EXPECT_EQ(write(true)->written, 3U);
  EXPECT_EQ(raw_from_png(read_file(second))->bytes, grey);
}

TEST_F(PictureExport, CountsWhatIsNotThere) {
  const Bytes grey = noise(1, width * height);
  add(std::chrono::seconds(1), 1, PixelFormat::grey, grey);
  add(std::chrono::seconds(2), 2, PixelFormat::grey, std::nullopt);
  add(std::chrono::seconds(3), 3, PixelFormat::grey, noise(2, 5));
  const auto done = write();
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->written, 1U);
  EXPECT_EQ(done->absent, 1U);
  EXPECT_EQ(done->damaged, 1U);
  session_.transfers.clear();
  EXPECT_EQ(write(true).error().fault, Fault::not_found);
  session_.devices.push_back({2, {.name = "pad", .kind = DeviceKind::touch}});
  session_.samples.push_back({2, TouchSample{}, 0});
  EXPECT_EQ(
      write_pictures(session_, find_stream(session_, "pad").value(), folder_, true, nothing).error().fault,
      Fault::usage);
}

TEST_F(PictureExport, AFolderThatCannotBeMadeIsNamed) {
  add(std::chrono::seconds(1), 1, PixelFormat::grey, noise(1, width * height));
  std::ofstream(folder_.string()) << "a file";
  const auto refused = write();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().fault, Fault::no_access);
  EXPECT_NE(refused.error().message.find(folder_.filename().string()), std::string::npos);
}

}  // namespace
}  // namespace fude
