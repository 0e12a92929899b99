#include "capture/import/import.h"

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "capture/import/gzip.h"

namespace fude {
namespace {

constexpr const char* description = "N: A Pen\nI: 0003 056a 00b9 0104\n";
constexpr const char* events = "E: 0.1 0000 0000 0\n";

std::string packed(const std::string& text) {
  z_stream stream{};
  deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string bytes(deflateBound(&stream, text.size()) + 32, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  bytes.resize(stream.total_out);
  deflateEnd(&stream);
  return bytes;
}

class ImportFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("fude-import-" + std::to_string(getpid()) + "-" +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path write(const std::string& name, const std::string& content) {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  std::filesystem::path folder_;
};

TEST(Recognise, ByContent) {
  EXPECT_EQ(recognise("# EVEMU 1.3\n"), ImportFormat::evemu);
  EXPECT_EQ(recognise("# a comment\nN: A Pen\n"), ImportFormat::evemu);
  EXPECT_EQ(recognise("E: 0.1 0000 0000 0\n"), ImportFormat::evemu);
  EXPECT_EQ(recognise("# libinput record\nversion: 1\n"), ImportFormat::libinput);
  EXPECT_EQ(recognise("version: 1\nndevices: 1\nlibinput:\n"), ImportFormat::libinput);
  EXPECT_EQ(recognise("\n0 1 2 0.5\n"), ImportFormat::mypaint_events);
  EXPECT_EQ(recognise("# 1:0\nD:0\nR: 1 c0\nN: A Pen\n"), ImportFormat::hid_recorder);
  EXPECT_EQ(recognise("N: A Pen\nI: 3 056a 0061\nR: 1 c0\n"), ImportFormat::hid_recorder);
  EXPECT_EQ(recognise("\n003:007:000:STREAM  1557634289.487561\n 08 80\n"), ImportFormat::usbhid_dump);
  EXPECT_EQ(recognise("0x19 0x81 0x3 0x7 0x0\n"), ImportFormat::joycon_uart);
  EXPECT_EQ(
      recognise(
          "t_s,gyr_x_radps,gyr_y_radps,gyr_z_radps,acc_x_mps2,acc_y_mps2,acc_z_mps2,opt_qw,opt_qx,opt_qy,"
          "opt_qz,opt_x,opt_y,opt_z\n"),
      ImportFormat::imu_csv);
  EXPECT_EQ(recognise("frame_number,t_s,a_qw,a_qx,a_qy,a_qz,a_x,a_y,a_z\n"), ImportFormat::poses_csv);
  EXPECT_EQ(recognise("frame_number,t_s,more\n"), ImportFormat::timestamps_csv);
  EXPECT_EQ(recognise("stroke,stroke_t0_unix_ms,t_rel_ms,x_px,y_px,pressure\n"), ImportFormat::wacom_ink_csv);
  EXPECT_EQ(recognise("1\n1 2 0.5 1 510 520 0\n"), ImportFormat::svc);
  EXPECT_FALSE(recognise("hello"));
  EXPECT_FALSE(recognise(""));
}

TEST(ImportBytes, AMessageThatQuotesAStrangersBytesIsOneLine) {
  ImportOptions options;
  options.format = ImportFormat::libinput;
  const auto imported = import_bytes("version: \"\\\n\"\n\"\\\x01", options);
  ASSERT_FALSE(imported.has_value());
  EXPECT_EQ(imported.error().message.find_first_of("\n\x01"), std::string::npos) << imported.error().message;
}

TEST(ImportBytes, GzipIsUnpacked) {
  const auto imported = import_bytes(packed(std::string(description) + events), {});
  ASSERT_TRUE(imported) << imported.error().message;
  EXPECT_EQ(imported->recordings.at(0).counts.frames, 1u);
}

TEST(ImportBytes, GzipMembersFollowOneAnother) {
  EXPECT_EQ(unpack_gzip(packed("one ") + packed("two")).value(), "one two");
}

TEST(ImportBytes, DamagedGzipIsRefused) {
  const std::string whole = packed(std::string(20000, 'x') + description);
  for (std::size_t length : {std::size_t{2}, std::size_t{11}, whole.size() / 2, whole.size() - 1}) {
    const auto cut = unpack_gzip(whole.substr(0, length));
    ASSERT_FALSE(cut);
    EXPECT_NE(cut.error().message.find("cut short"), std::string::npos) << cut.error().message;
  }
  std::string damaged = whole;
  damaged[whole.size() - 6] = static_cast<char>(damaged[whole.size() - 6] ^ 0x55);
  EXPECT_NE(unpack_gzip(damaged).error().message.find("damaged"), std::string::npos);
}

TEST(ImportBytes, AFileThatUnpacksWithoutEndIsRefused) {
  const std::string bomb = packed(std::string(largest_import + 1, '#'));
  ASSERT_LT(bomb.size(), std::size_t{1} << 20);
  const auto unpacked = unpack_gzip(bomb);
  ASSERT_FALSE(unpacked);
  EXPECT_EQ(unpacked.error().fault, Fault::unsupported);
}

TEST(ImportBytes, UnknownAndEmptyFilesSayWhatToDo) {
  EXPECT_NE(import_bytes("hello world", {}).error().message.find("--from"), std::string::npos);
  EXPECT_NE(import_bytes(" \n", {}).error().message.find("empty"), std::string::npos);
}

TEST(ImportFormat, NamesRoundTrip) {
  for (ImportFormat format : {ImportFormat::evemu, ImportFormat::libinput, ImportFormat::mypaint_events})
    EXPECT_EQ(import_format(name_of(format)), format);
  EXPECT_FALSE(import_format("auto"));
}

TEST_F(ImportFile, LongestDescriptionWhoseStemBeginsTheNameIsTaken) {
  write("Pen.desc", "N: Short\n");
  const auto best = write("Pen_6x9.desc", description);
  write("Other.desc", "N: Other\n");
  const auto file = write("Pen_6x9.drag.events", events);
  const auto imported = import_file(file, {});
  ASSERT_TRUE(imported) << imported.error().message;
  EXPECT_EQ(imported->description, best);
  EXPECT_EQ(imported->recordings.at(0).device->name, "A Pen");
}

TEST_F(ImportFile, TheFilesOwnDescriptionNeedsNoOther) {
  write("Pen.desc", "N: Beside\n");
  const auto imported = import_file(write("Pen.events", std::string(description) + events), {});
  ASSERT_TRUE(imported);
  EXPECT_FALSE(imported->description);
  EXPECT_EQ(imported->recordings.at(0).device->name, "A Pen");
}

TEST_F(ImportFile, AGivenDescriptionRules) {
  ImportOptions options;
  options.device = write("elsewhere.txt", "N: Given\n");
  const auto imported = import_file(write("Pen.events", std::string(description) + events), options);
  ASSERT_TRUE(imported);
  EXPECT_EQ(imported->recordings.at(0).device->name, "Given");
  options.device = write("empty.txt", "# nothing\n");
  const auto refused = import_file(folder_ / "Pen.events", options);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("empty.txt"), std::string::npos) << refused.error().message;
}

TEST_F(ImportFile, WithoutAnyDescriptionEventsAreKeptRaw) {
  const auto imported = import_file(write("Pen.events", events), {});
  ASSERT_TRUE(imported);
  EXPECT_FALSE(imported->recordings.at(0).device);
  EXPECT_EQ(imported->recordings.at(0).counts.events, 1u);
}

TEST_F(ImportFile, MissingFilesAndFoldersAreNamed) {
  const auto missing = import_file(folder_ / "none.events", {});
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().fault, Fault::not_found);
  EXPECT_NE(missing.error().message.find("none.events"), std::string::npos);
  EXPECT_EQ(import_file(folder_, {}).error().fault, Fault::not_found);
}

}  // namespace
}  // namespace fude
