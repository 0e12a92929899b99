#include "rig/monitor_page.h"

#include <gtest/gtest.h>

#include <chrono>
#include <sstream>

namespace fude {
namespace {

StreamFigures heard() {
  StreamMeter meter(std::nullopt);
  Duration host{};
  for (int i = 0; i < 100; ++i) {
    meter.add({.host = Timestamp(host)}, false);
    host += std::chrono::microseconds(i == 50 ? 5400 : 5000);
  }
  return meter.figures();
}

PenSample leaning(double right_degrees, double near_degrees) {
  PenSample pen;
  pen.tool = PenTool::pen;
  pen.x_counts = 1234;
  pen.tilt_x = degrees(right_degrees);
  pen.tilt_y = degrees(near_degrees);
  return pen;
}

TEST(MonitorPage, ShowsValuesRateAndJitter) {
  const std::string page = monitor_page({.id = "056a:0304:7", .name = "Pen"}, leaning(0, 0), heard());
  EXPECT_NE(page.find("Pen  056a:0304:7\n"), std::string::npos) << page;
  EXPECT_NE(page.find("100 samples, 200.0 a second, 0 gaps"), std::string::npos) << page;
  EXPECT_NE(page.find("x_counts                1234"), std::string::npos) << page;
  EXPECT_NE(page.find("under    50 us       98 ####"), std::string::npos) << page;
  EXPECT_NE(page.find("under   500 us        1 #\n"), std::string::npos) << page;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 78U) << line;
}

TEST(MonitorPage, TheDialLeansAsThePenDoes) {
  const auto dial = [](double right, double near) {
    const std::string page = monitor_page({}, leaning(right, near), heard());
    std::istringstream lines(page.substr(page.find("tilt: ")));
    std::string line;
    std::getline(lines, line);
    for (int row = 0; std::getline(lines, line); ++row)
      if (const auto column = line.find('O'); column != std::string::npos)
        return std::pair(row, static_cast<int>(column));
    return std::pair(-1, -1);
  };
  EXPECT_EQ(dial(0, 0), std::pair(6, 20));
  EXPECT_EQ(dial(60, 0), std::pair(6, 40));
  EXPECT_EQ(dial(-30, 0), std::pair(6, 10));
  EXPECT_EQ(dial(0, -60), std::pair(0, 20));  // away from the painter is up
  EXPECT_EQ(dial(90, 90), std::pair(12, 40));
}

TEST(MonitorPage, OfASilentDeviceSaysSo) {
  EXPECT_NE(monitor_page({}, std::nullopt, {}).find("nothing heard yet"), std::string::npos);
}

}  // namespace
}  // namespace fude
