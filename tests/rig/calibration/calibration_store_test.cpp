// Calibrations kept in versions: none is lost, none is taken for another's.
#include "rig/calibration/calibration_store.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <set>

#include "rig/calibration/known_calibrations.h"
#include "rig/calibration/passport.h"

namespace fude {
namespace {

namespace fs = std::filesystem;

StoredCalibration pivot(double tip_m, const std::string& device = "0f44:ff20:A",
                        const std::string& tool = "brush") {
  StoredCalibration made;
  made.report = {.procedure = "pivot", .accepted = true, .devices = {device}, .tool = tool};
  made.result = {{"tool", tool}, {"tip_m", std::vector{tip_m, 0.0, 0.0}}};
  return made;
}

class Store : public testing::Test {
 protected:
  void TearDown() override { fs::remove_all(folder_); }

  double current_tip(const std::string& device = "0f44:ff20:A") const {
    for (const KeptCalibration& kept : store_.current(warnings_))
      if (kept.calibration.report.devices.front() == device)
        return numbers_in(kept.calibration.result, "tip_m")->front();
    return 0;
  }

  fs::path folder_ = fs::path(testing::TempDir()) / ("fude-store-" + std::to_string(getpid()));
  CalibrationStore store_{folder_};
  mutable std::vector<std::string> warnings_;
};

TEST_F(Store, RollingBackTakesWhatWasInUseBefore) {
  EXPECT_EQ(store_.keep(pivot(1))->version, 1);
  EXPECT_EQ(store_.keep(pivot(2))->version, 2);
  EXPECT_EQ(store_.roll_back("pivot", "", "")->version, 1);
  EXPECT_EQ(current_tip(), 1);
  // A third one follows the first, for the second was given up.
  EXPECT_EQ(store_.keep(pivot(3))->version, 3);
  EXPECT_EQ(current_tip(), 3);
  EXPECT_EQ(store_.roll_back("pivot", "", "")->version, 1);
  const auto none = store_.roll_back("pivot", "", "");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().fault, Fault::not_found);
  EXPECT_EQ(current_tip(), 1);
  EXPECT_EQ(store_.all(warnings_).size(), 3U);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(Store, DevicesAndToolsAreKeptApart) {
  ASSERT_TRUE(store_.keep(pivot(1)));
  ASSERT_TRUE(store_.keep(pivot(2, "0f44:ff20:B")));
  ASSERT_TRUE(store_.keep(pivot(3, "0f44:ff20:A", "../p%")));
  ASSERT_TRUE(store_.keep(pivot(4)));
  EXPECT_EQ(store_.current(warnings_).size(), 3U);
  const auto several = store_.roll_back("pivot", "0f44:ff20:A", "");
  ASSERT_FALSE(several);
  EXPECT_EQ(several.error().fault, Fault::usage);
  EXPECT_EQ(store_.roll_back("pivot", "0f44:ff20:A", "brush")->version, 1);
  EXPECT_FALSE(store_.roll_back("surface", "", ""));
  // Everything lies below the store, whatever a tool is called.
  for (const auto& entry : fs::directory_iterator(folder_ / "pivot"))
    EXPECT_EQ(entry.path().filename().string().find('/'), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_.parent_path() / "p%"));
}

TEST_F(Store, AFileThatIsDamagedIsToldAndPassedOver) {
  ASSERT_TRUE(store_.keep(pivot(1)));
  const auto second = store_.keep(pivot(2));
  std::ofstream(second->file) << "tip_m = [";
  EXPECT_EQ(store_.all(warnings_).size(), 1U);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_.front().find(second->file.filename().string()), std::string::npos);
}

TEST_F(Store, WhatCannotBeWrittenIsSaid) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "pivot") << "in the way";
  const auto kept = store_.keep(pivot(1));
  ASSERT_FALSE(kept);
  EXPECT_NE(kept.error().message.find("XDG_DATA_HOME"), std::string::npos) << kept.error().message;
}

TEST_F(Store, ProcessesThatKeepAtOnceLoseNothing) {
  constexpr int processes = 4, each = 10;
  std::vector<pid_t> children;
  for (int p = 0; p < processes; ++p) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      bool all = true;
      for (int i = 0; i < each; ++i) all = all && store_.keep(pivot(p * each + i + 1)).has_value();
      _exit(all ? 0 : 1);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
  }
  std::set<double> tips;
  std::set<int> versions;
  for (const KeptCalibration& kept : store_.all(warnings_)) {
    tips.insert(numbers_in(kept.calibration.result, "tip_m")->front());
    versions.insert(kept.version);
  }
  EXPECT_EQ(tips.size(), std::size_t{processes * each});
  EXPECT_EQ(versions.size(), std::size_t{processes * each});
  EXPECT_EQ(store_.current(warnings_).size(), 1U);
}

TEST_F(Store, OnlyTheKeptOneOfJustThisDeviceAndToolIsTaken) {
  ASSERT_TRUE(store_.keep(pivot(1)));
  ASSERT_TRUE(store_.keep(pivot(2, "text:poses")));
  KnownCalibrations known;
  std::vector<StoredCalibration> kept;
  for (const KeptCalibration& k : store_.current(warnings_)) kept.push_back(k.calibration);
  known.keep(kept);
  EXPECT_EQ(tip_of("surface", {}, known, {1, {.id = "0f44:ff20:A"}, "brush"})->x(), 1);
  for (const ChosenStream& other :
       {ChosenStream{1, {.id = "0f44:ff20:B"}, "brush"}, ChosenStream{1, {.id = "0f44:ff20:A"}, "probe"},
        ChosenStream{1, {.id = "text:poses"}, "brush"}}) {
    const auto tip = tip_of("surface", {}, known, other);
    ASSERT_FALSE(tip);
    EXPECT_NE(tip.error().message.find("of the tool brush of 0f44:ff20:A is kept"), std::string::npos)
        << tip.error().message;
  }
}

TEST_F(Store, ASessionCarriesThoseOfItsDevicesAndTheyGoBeforeTheKept) {
  StoredCalibration both = pivot(5);
  both.report.procedure = "tracker";
  both.report.devices.push_back("0f44:ff20:B");
  Passport passport({pivot(1), pivot(2, "0f44:ff20:C"), both});
  Session session;
  for (const char* device : {"0f44:ff20:A", "0f44:ff20:B"}) {
    auto carried = passport.begin({.id = device});
    ASSERT_EQ(carried.size(), 1U) << device;
    session.calibrations.push_back(std::move(carried.front()));
  }
  EXPECT_EQ(session.calibrations.front().name, "pivot brush");
  EXPECT_EQ(session.calibrations.back().name, "tracker brush");
  session.calibrations.push_back({"receivers", "receivers_m = [[0, 0, 0]]\n"});  // no calibration of ours
  KnownCalibrations known;
  known.carry(session);
  known.keep({pivot(7)});
  EXPECT_EQ(tip_of("surface", {}, known, {1, {.id = "0f44:ff20:A"}, "brush"})->x(), 1);
}

}  // namespace
}  // namespace fude
