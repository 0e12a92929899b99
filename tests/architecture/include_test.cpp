// The rooms' include rule, read off the include lines: a wrong arrow fails the build's tests.
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace fude {
namespace {

namespace fs = std::filesystem;

// Who may include whom (DESIGN: signal, then the five in the middle, then rig, then app).
const std::map<std::string, std::set<std::string>> allowed{
    {"signal", {"signal"}},
    {"drivers", {"drivers", "signal"}},
    {"capture", {"capture", "signal"}},
    {"calibration", {"calibration", "signal"}},
    {"vision", {"vision", "signal"}},
    {"sim/compute", {"sim/compute", "signal"}},
    {"sim/ink", {"sim/ink", "sim/compute", "signal"}},
    {"sim/brush", {"sim/brush", "signal"}},
    {"sim/optics", {"sim/optics", "signal"}},
    {"rig",
     {"rig", "signal", "drivers", "capture", "calibration", "vision", "sim/compute", "sim/ink", "sim/brush",
      "sim/optics"}},
    {"app",
     {"app", "rig", "signal", "drivers", "capture", "calibration", "vision", "sim/compute", "sim/ink", "sim/brush",
      "sim/optics"}},
};

std::string room_of(const std::string& path) {
  for (const auto& [room, ignored] : allowed)
    if (path.starts_with(room + "/")) return room;
  return "";
}

std::vector<std::string> included(const fs::path& file) {
  static const std::regex line(R"(^\s*#\s*include\s+\"([^\"]+)\")");
  std::vector<std::string> paths;
  std::ifstream in(file);
  std::smatch found;
  for (std::string text; std::getline(in, text);)
    if (std::regex_search(text, found, line)) paths.push_back(found[1]);
  return paths;
}

bool is_code(const fs::path& file) {
  return file.extension() == ".h" || file.extension() == ".cpp" || file.extension() == ".inl" ||
         file.extension() == ".k";
}

TEST(Rooms, IncludeOnlyWhatStandsToTheirLeft) {
  const fs::path root = FUDE_SOURCE_DIR;
  int arrows = 0;
  for (const char* top : {"signal", "drivers", "capture", "calibration", "vision", "sim", "rig", "app"}) {
    if (!fs::exists(root / top)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      if (!entry.is_regular_file() || !is_code(entry.path())) continue;
      const std::string file = fs::relative(entry.path(), root).string();
      const std::string room = room_of(file);
      ASSERT_FALSE(room.empty()) << file << " stands in no room";
      for (const std::string& path : included(entry.path())) {
        const std::string other = room_of(path);
        ++arrows;
        EXPECT_FALSE(other.empty()) << file << " includes \"" << path << "\", which is not named from the root";
        EXPECT_TRUE(other.empty() || allowed.at(room).contains(other)) << file << " must not include " << path;
        EXPECT_TRUE(fs::exists(root / path)) << file << " includes " << path;
      }
    }
  }
  EXPECT_GT(arrows, 20);
}

TEST(Rooms, AHeaderThatBelongsToAnotherRoomIsSeen) {
  EXPECT_EQ(room_of("sim/ink/ink.h"), "sim/ink");
  EXPECT_FALSE(allowed.at("sim/brush").contains(room_of("sim/ink/ink.h")));
  EXPECT_FALSE(allowed.at("capture").contains(room_of("drivers/tablet/pen.h")));
}

}  // namespace
}  // namespace fude
