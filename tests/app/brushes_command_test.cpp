// `fude brushes` and `fude brushes show` as a person calls them.
#include <gtest/gtest.h>
#include <png.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace fude {
namespace {

namespace fs = std::filesystem;

struct Answer {
  std::string text;
  int status = -1;
};

Answer fude(const fs::path& home, const std::string& words) {
  const std::string command = "XDG_DATA_HOME=" + home.string() + " " FUDE_PROGRAM " " + words + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  Answer answer;
  for (int c = 0; (c = std::fgetc(pipe)) != EOF;) answer.text.push_back(static_cast<char>(c));
  answer.status = WEXITSTATUS(pclose(pipe));
  return answer;
}

class Brushes : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "fude_brushes_XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    home = pattern;
    fs::create_directories(home / "fude/brushes");
    std::ofstream(home / "fude/brushes/my-own.toml")
        << "# A short one of mine.\nname = \"my-own\"\ntuft_length_mm = 12\nlongest_step_s = 0.004\n";
  }
  void TearDown() override { fs::remove_all(home); }
  fs::path home;
};

TEST_F(Brushes, AreListedWithOnesOwn) {
  const Answer list = fude(home, "brushes");
  EXPECT_EQ(list.status, 0);
  EXPECT_NE(list.text.find("round-goat"), std::string::npos) << list.text;
  EXPECT_NE(list.text.find("my-own"), std::string::npos) << list.text;
  EXPECT_NE(list.text.find("A short one of mine."), std::string::npos) << list.text;
}

TEST_F(Brushes, AreShownInAPose) {
  const std::string picture = (home / "one.png").string();
  const std::string words = "brushes show my-own --pose 5,-3,8,10,30 --size 320x240 --out " + picture;
  const Answer shown = fude(home, words);
  EXPECT_EQ(shown.status, 0) << shown.text;
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&png, picture.c_str()));
  EXPECT_EQ(png.width, 320U);
  EXPECT_EQ(png.height, 240U);
  png_image_free(&png);
  const Answer again = fude(home, words);
  EXPECT_EQ(again.status, 1);
  EXPECT_NE(again.text.find("--force"), std::string::npos) << again.text;
}

TEST_F(Brushes, SayWhatIsWrong) {
  const std::string out = " --out " + (home / "none.png").string();
  for (const char* pose : {"1,2", "1,2,x", "nan,0,5", "1,2,3,4,5,6,7", "0,0,9000"}) {
    const Answer wrong = fude(home, std::string("brushes show my-own --pose ") + pose + out);
    EXPECT_EQ(wrong.status, 2) << pose;
    EXPECT_NE(wrong.text.find("pose"), std::string::npos) << wrong.text;
  }
  EXPECT_EQ(fude(home, "brushes show broom --pose 0,0,5" + out).status, 1);
  EXPECT_FALSE(fs::exists(home / "none.png"));
}

}  // namespace
}  // namespace fude
