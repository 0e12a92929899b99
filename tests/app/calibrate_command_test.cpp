// `fude calibrate` as a person or a script runs it: options in any order, exit status, files, and what is
// kept.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "capture/session_writer.h"
#include "tests/fakes/scripted_tracker.h"

namespace fude {
namespace {

namespace fs = std::filesystem;

class CalibrateCommand : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_);
    session("turning.fude", ScriptedPivot{}.samples());
    session("rocking.fude", ScriptedPivot{.flatness = 0}.samples());
  }
  void TearDown() override { fs::remove_all(folder_); }

  void session(const std::string& name, const std::vector<PoseSample>& samples) {
    auto writer = SessionWriter::create(folder_ / name);
    ASSERT_TRUE(writer);
    const auto number =
        writer->add_device({.id = "0f44:ff20:A1", .name = "tracker", .kind = DeviceKind::tracker});
    for (const PoseSample& sample : samples) ASSERT_TRUE(writer->add_sample(*number, sample));
    ASSERT_TRUE(writer->close());
  }

  // In the test's folder, with the user's data below it. Gives the exit status; `said_` is all that it said.
  int fude(const std::string& arguments) {
    const std::string command = "cd '" + folder_.string() + "' && XDG_DATA_HOME='" + folder_.string() +
                                "/data' '" FUDE_PROGRAM "' " + arguments + " >said 2>&1 </dev/null";
    const int status = std::system(command.c_str());
    said_ = text("said");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string text(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(text(name)); }
  bool there(const std::string& name) const { return fs::exists(folder_ / name); }

  fs::path folder_ = fs::path(testing::TempDir()) / ("fude-command-" + std::to_string(getpid()));
  std::string said_;
};

TEST_F(CalibrateCommand, OptionsMayStandInAnyOrderAfterWhat) {
  EXPECT_EQ(fude("calibrate pivot turning.fude --tool brush --out a.toml --report a.json"), 0) << said_;
  EXPECT_EQ(fude("calibrate pivot --report b.json --out b.toml --tool tracker turning.fude --cal a.toml"), 0)
      << said_;
  EXPECT_EQ(json("a.json")["result"], json("b.json")["result"]);
  EXPECT_TRUE(json("a.json")["accepted"]);
  EXPECT_EQ(json("a.json")["devices"], nlohmann::json::array({"0f44:ff20:A1"}));
  EXPECT_EQ(fude("calibrate surface --tip-mm -14,150,-7 turning.fude --report c.json"), 1) << said_;
  EXPECT_FALSE(json("c.json")["accepted"]);
}

TEST_F(CalibrateCommand, ARefusalLeavesAReportAndNoCalibration) {
  EXPECT_EQ(fude("calibrate pivot rocking.fude --out no.toml --report no.json"), 1);
  EXPECT_FALSE(there("no.toml"));
  EXPECT_FALSE(json("no.json")["accepted"]);
  EXPECT_NE(said_.find("fude: refused: "), std::string::npos) << said_;
  EXPECT_FALSE(there("data"));
  EXPECT_EQ(fude("calibrate pivot absent.fude --report absent.json"), 1);
  EXPECT_FALSE(json("absent.json")["accepted"]);
}

TEST_F(CalibrateCommand, WrongUsageIsTwo) {
  EXPECT_EQ(fude("calibrate"), 2);
  EXPECT_EQ(fude("calibrate nonsense turning.fude"), 2);
  EXPECT_EQ(fude("calibrate pivot"), 2);
  EXPECT_NE(said_.find("--live"), std::string::npos) << said_;
  EXPECT_EQ(fude("calibrate pivot turning.fude --corners"), 2);  // the surface's
  for (const char* tip : {"1,2", "1,2,3,4", "1,2,x", "nan,0,0"})
    EXPECT_EQ(fude("calibrate surface turning.fude --tip-mm " + std::string(tip)), 2) << tip;
}

TEST_F(CalibrateCommand, WhatIsAcceptedIsKeptAndMayBeRolledBack) {
  EXPECT_EQ(fude("calibrate pivot turning.fude --no-keep"), 0) << said_;
  EXPECT_FALSE(there("data"));
  EXPECT_EQ(fude("calibrate pivot turning.fude"), 0) << said_;
  EXPECT_EQ(fude("calibrate pivot turning.fude"), 0) << said_;
  EXPECT_EQ(fude("calibrate list --json"), 0);
  auto kept = json("said");
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_FALSE(kept[0]["current"]);
  EXPECT_TRUE(kept[1]["current"]);
  EXPECT_TRUE(fs::exists(kept[1]["file"].get<std::string>()));
  EXPECT_EQ(fude("calibrate rollback pivot --device 0f44:ff20:A1"), 0) << said_;
  EXPECT_EQ(fude("calibrate list --json"), 0);
  kept = json("said");
  EXPECT_TRUE(kept[0]["current"]);
  EXPECT_FALSE(kept[1]["current"]);
  EXPECT_EQ(fude("calibrate rollback pivot"), 1);
  // The kept pivot is the surface's tip: what is refused now is the touching, not the want of a tip.
  EXPECT_EQ(fude("calibrate surface turning.fude"), 1);
  EXPECT_EQ(said_.find("needs the tip"), std::string::npos) << said_;
}

TEST_F(CalibrateCommand, NothingIsReplacedWithoutForce) {
  std::ofstream(folder_ / "mine.toml") << "mine";
  EXPECT_EQ(fude("calibrate pivot turning.fude --out mine.toml"), 1);
  EXPECT_EQ(text("mine.toml"), "mine");
  EXPECT_EQ(fude("calibrate pivot turning.fude --out mine.toml --force"), 0) << said_;
  EXPECT_NE(text("mine.toml").find("tip_m"), std::string::npos);
}

}  // namespace
}  // namespace fude
