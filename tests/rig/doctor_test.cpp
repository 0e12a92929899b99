// What the doctor says of machines that are pretended, and of folders made for it.
#include "rig/doctor.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace fude {
namespace {

namespace fs = std::filesystem;

// All is there.
Machine healthy() {
  Machine machine;
  machine.devices = {{"Intuos", "/dev/input/event5", true, false, true},
                     {"Webcam", "/dev/video0", false, true, true}};
  machine.rule = "/etc/udev/rules.d/70-fude.rules";
  machine.own_rule = "/share/udev/70-fude.rules";
  machine.uinput_there = machine.uinput_writable = true;
  machine.display = true;
  machine.opengl = {"4.6", "A card", false};
  machine.folder = "/home/painter";
  machine.folder_writable = true;
  machine.free_bytes = 50'000'000'000;
  machine.stamp_ahead = Duration(0);
  return machine;
}

Finding about(const Machine& machine, const std::string& subject) {
  const auto findings = diagnose(machine);
  const auto found = std::find_if(findings.begin(), findings.end(),
                                  [&](const Finding& finding) { return finding.subject == subject; });
  EXPECT_NE(found, findings.end()) << subject;
  return found == findings.end() ? Finding{} : *found;
}

TEST(Doctor, AHealthyMachineLacksNothing) {
  const auto findings = diagnose(healthy());
  EXPECT_TRUE(can_paint(findings));
  for (const Finding& finding : findings) {
    EXPECT_EQ(finding.standing, Standing::good) << finding.subject << ": " << finding.says;
    EXPECT_EQ(finding.command, "") << finding.subject;
  }
}

TEST(Doctor, WhatMendsATabletThatMayNotBeRead) {
  Machine machine = healthy();
  machine.devices[0].access = false;
  EXPECT_EQ(about(machine, "Intuos").command, "sudo usermod -aG input $USER");
  EXPECT_FALSE(can_paint(diagnose(machine)));
  machine.rule.reset();
  EXPECT_EQ(
      about(machine, "Intuos").command,
      "sudo install -m 644 /share/udev/70-fude.rules /etc/udev/rules.d/ && sudo udevadm control --reload "
      "&& sudo udevadm trigger");
  EXPECT_EQ(about(machine, "udev rule").command, about(machine, "Intuos").command);
}

TEST(Doctor, OtherDevicesThatMayNotBeReadDoNotHinder) {
  for (const auto& [node, group] :
       {std::pair("/dev/video0", "video"), std::pair("/dev/ttyACM0", "dialout")}) {
    Machine machine = healthy();
    machine.devices[1] = {"Other", node, false, group == std::string("video"), false};
    const Finding finding = about(machine, "Other");
    EXPECT_EQ(finding.standing, Standing::lacking);
    EXPECT_EQ(finding.command, std::string("sudo usermod -aG ") + group + " $USER");
    EXPECT_TRUE(can_paint(diagnose(machine)));
  }
}

TEST(Doctor, AMouseIsEnough) {
  Machine machine = healthy();
  machine.devices.clear();
  EXPECT_EQ(about(machine, "pen tablet").standing, Standing::lacking);
  EXPECT_EQ(about(machine, "camera").standing, Standing::lacking);
  machine.udev = false;
  EXPECT_EQ(about(machine, "udev").standing, Standing::lacking);
  EXPECT_TRUE(can_paint(diagnose(machine)));
}

TEST(Doctor, GroupsMatterOnlyWithoutTheRule) {
  Machine machine = healthy();
  EXPECT_EQ(about(machine, "groups").standing, Standing::good);
  machine.rule.reset();
  machine.groups = {"painters", "video"};
  EXPECT_EQ(about(machine, "groups").command, "sudo usermod -aG input,dialout $USER");
  machine.root = true;
  EXPECT_EQ(about(machine, "groups").standing, Standing::good);
}

TEST(Doctor, UinputIsMadeOrOpened) {
  Machine machine = healthy();
  machine.uinput_writable = false;
  EXPECT_EQ(about(machine, "uinput").command, "sudo setfacl -m u:$USER:rw /dev/uinput");
  machine.uinput_there = false;
  EXPECT_EQ(about(machine, "uinput").command, "sudo modprobe uinput");
  EXPECT_TRUE(can_paint(diagnose(machine)));
}

TEST(Doctor, WithoutAWindowThereIsNoPainting) {
  Machine machine = healthy();
  machine.display = false;
  EXPECT_EQ(about(machine, "display").standing, Standing::hinders);
  machine = healthy();
  machine.opengl.reset();
  machine.no_opengl = "libEGL is missing";
  EXPECT_EQ(about(machine, "OpenGL").says, "libEGL is missing");
  EXPECT_FALSE(can_paint(diagnose(machine)));
}

TEST(Doctor, ASoftwareRendererIsNamedAndWillDo) {
  Machine machine = healthy();
  machine.opengl = {"4.5", "llvmpipe", true};
  EXPECT_EQ(about(machine, "OpenGL").says, "4.5, llvmpipe (software: slow)");
  EXPECT_TRUE(can_paint(diagnose(machine)));
}

TEST(Doctor, TheFoldersRoomAndClock) {
  Machine machine = healthy();
  machine.free_bytes = 500'000'000;
  EXPECT_EQ(about(machine, "disk").standing, Standing::lacking);
  machine.free_bytes = 1'000'000;
  EXPECT_EQ(about(machine, "disk").standing, Standing::hinders);
  machine = healthy();
  machine.stamp_ahead = std::chrono::seconds(-75);
  EXPECT_EQ(about(machine, "clock").says,
            "files in /home/painter are stamped 75 s behind this machine's clock");
  machine.folder_writable = false;
  EXPECT_EQ(about(machine, "session folder").standing, Standing::hinders);
}

class DoctorFiles : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "fude-doctor-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    root_ = name;
  }
  void TearDown() override { fs::remove_all(root_); }
  fs::path root_;
};

TEST_F(DoctorFiles, TheRuleIsFoundWhereUdevReadsIt) {
  EXPECT_FALSE(installed_rule(root_));
  for (const char* folder : {"usr/lib/udev/rules.d", "etc/udev/rules.d"}) {
    fs::create_directories(root_ / folder);
    std::ofstream(root_ / folder / "70-fude.rules") << "#";
    EXPECT_EQ(installed_rule(root_), root_ / folder / "70-fude.rules") << "the first that udev takes";
  }
}

TEST_F(DoctorFiles, AFolderIsTriedAndLeftAsItWas) {
  Machine machine;
  examine_folder(root_, machine);
  EXPECT_TRUE(machine.folder_writable);
  EXPECT_GT(machine.free_bytes, 0u);
  EXPECT_TRUE(machine.stamp_ahead);
  EXPECT_TRUE(fs::is_empty(root_));
  examine_folder(root_ / "nowhere", machine);
  EXPECT_FALSE(machine.folder_writable);
}

}  // namespace
}  // namespace fude
