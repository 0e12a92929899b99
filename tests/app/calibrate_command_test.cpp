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
#include <string>
#include <vector>

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
  int fude(const std::string& arguments, const std::string& typed = "") {
    std::ofstream(folder_ / "typed") << typed;
    const std::string command = "cd '" + folder_.string() + "' && XDG_DATA_HOME='" + folder_.string() +
                                "/data' '" FUDE_PROGRAM "' " + arguments + " >said 2>&1 <typed";
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

TEST_F(CalibrateCommand, EveryProcedureIsThere) {
  std::vector<std::string> names{"pivot",      "surface", "tracker", "common-motion",
                                 "distortion", "imu",     "imu-axes"};
#ifdef FUDE_VISION
  names.insert(names.end(), {"camera", "camera-pose"});
#endif
  for (const std::string& name : names) EXPECT_EQ(fude("calibrate " + name + " --help"), 0) << name;
}

TEST_F(CalibrateCommand, WrongUsageIsTwo) {
  EXPECT_EQ(fude("calibrate"), 2);
  EXPECT_NE(said_.find("pivot, surface"), std::string::npos) << said_;
  EXPECT_EQ(fude("calibrate nonsense turning.fude"), 2);
  EXPECT_NE(said_.find("nonsense"), std::string::npos) << said_;
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

// A brush that stands over an A4 sheet in z = 0 of the tracker, leaning differently at each place.
std::vector<PoseSample> touching(const std::vector<Eigen::Vector2d>& places_mm,
                                 const Eigen::Vector3d& moved_mm) {
  const Eigen::Vector3d tip_m(0, 0, -0.15);
  std::vector<PoseSample> samples;
  for (const Eigen::Vector2d& place : places_mm) {
    const double way = 2.1 * double(samples.size());
    const Eigen::Quaterniond leaned(Eigen::AngleAxisd(0.5, Eigen::Vector3d(std::cos(way), std::sin(way), 0)));
    const Eigen::Vector3d at_m = 1e-3 * (Eigen::Vector3d(place.x(), place.y(), 0) + moved_mm);
    for (int i = 0; i < 20; ++i)
      samples.push_back(pose_sample({leaned, at_m - leaned * tip_m + Eigen::Vector3d(1e-7 * i, 0, 0)},
                                    0.02 * double(samples.size())));
  }
  return samples;
}

TEST_F(CalibrateCommand, CheckSaysWhatMoved) {
  const std::vector<Eigen::Vector2d> corners{{0, 0}, {297, 0}, {297, 210}, {0, 210}};
  std::vector<Eigen::Vector2d> all = corners;
  for (int i = 1; i < 6; ++i)
    for (int j = 1; j < 5; ++j) all.emplace_back(50 * i, 42 * j);
  session("sheet.fude", touching(all, {0, 0, 0}));
  session("same.fude", touching({corners.begin(), corners.begin() + 3}, {0, 0, 0}));
  session("moved.fude", touching({corners.begin(), corners.begin() + 3}, {7, 0, 0}));
  ASSERT_EQ(fude("calibrate surface sheet.fude --corners --tip-mm 0,0,-150 --out sheet.toml --no-keep"), 0)
      << said_;
  EXPECT_EQ(fude("calibrate check same.fude --tip-mm 0,0,-150"), 2);  // of which surface?
  EXPECT_EQ(fude("calibrate check same.fude --cal sheet.toml --tip-mm 0,0,-150 --report same.json"), 0)
      << said_;
  EXPECT_EQ(json("same.json")["result"]["moved"], "nothing");
  EXPECT_EQ(fude("calibrate check moved.fude --cal sheet.toml --tip-mm 0,0,-150 --report moved.json"), 1);
  EXPECT_EQ(json("moved.json")["details"]["moved"], "paper");
  EXPECT_NEAR(json("moved.json")["details"]["paper_right_mm"].get<double>(), 7, 0.01);
  EXPECT_NE(said_.find("7.0 mm to the right"), std::string::npos) << said_;
  EXPECT_FALSE(there("data"));  // a check is of its moment
}

TEST_F(CalibrateCommand, EnterEndsALiveOneOfWhichNothingWasHeard) {
  EXPECT_EQ(
      fude("calibrate pivot --live --tool absent --add openigtlink:127.0.0.1:1 --report live.json", "\n"), 1);
  EXPECT_NE(said_.find("there is no tool 'absent'"), std::string::npos) << said_;
  EXPECT_FALSE(json("live.json")["accepted"]);
  EXPECT_EQ(fude("calibrate pivot --live --add nonsense"), 2) << said_;
}

#ifdef FUDE_VISION
TEST_F(CalibrateCommand, TheCamerasCommandsAreThere) {
  EXPECT_EQ(fude("calibrate target --board charuco --columns 7 --rows 9 --square-mm 20 --out board.pdf"), 0)
      << said_;
  EXPECT_EQ(text("board.pdf").substr(0, 8), "%PDF-1.4");
  EXPECT_EQ(fude("calibrate target --out board.png --page a3"), 0) << said_;
  EXPECT_EQ(text("board.png").substr(1, 3), "PNG");
  EXPECT_EQ(fude("calibrate target --out board.jpg"), 2);
  EXPECT_EQ(fude("calibrate target --square-mm 40 --out large.pdf"), 2);
  EXPECT_FALSE(there("large.pdf"));
  EXPECT_EQ(fude("calibrate camera turning.fude --board charuco --columns 7 --rows 9 --square-mm 20"), 1);
  EXPECT_NE(said_.find("no camera was heard"), std::string::npos) << said_;
}
#endif

TEST_F(CalibrateCommand, NothingIsReplacedWithoutForce) {
  std::ofstream(folder_ / "mine.toml") << "mine";
  EXPECT_EQ(fude("calibrate pivot turning.fude --out mine.toml"), 1);
  EXPECT_EQ(text("mine.toml"), "mine");
  EXPECT_EQ(fude("calibrate pivot turning.fude --out mine.toml --force"), 0) << said_;
  EXPECT_NE(text("mine.toml").find("tip_m"), std::string::npos);
}

}  // namespace
}  // namespace fude
