#include "rig/calibration/pressure.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

#include "rig/calibration/stream_calibrator.h"

namespace fude {

std::unique_ptr<Calibrator> pressure_calibrator(PressureWish wish) {
  return std::make_unique<StreamCalibrator<PenSample, PressureProcedure>>(
      std::move(wish.tablet), "tablet", PressureProcedure(std::move(wish.weighings)),
      [](CalibrationOutcome& outcome, const DeviceDescription& tablet) {
        outcome.report.from_frame = "pressure of " + tablet.name;
      });
}

Result<std::vector<Weighing>> weighings_from(std::string_view text, const std::string& source) {
  std::vector<Weighing> weighings;
  std::istringstream in{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    line = line.substr(0, line.find('#'));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    if (weighings.empty() && line.starts_with("host_s,")) continue;  // a heading
    double at_s = 0, grams = 0;
    int length = 0;
    constexpr double latest_s = 9e9;  // of nanoseconds that a Timestamp holds
    if (std::sscanf(line.c_str(), "%lf ,%lf %n", &at_s, &grams, &length) != 2 ||
        line[std::size_t(length)] != '\0' || !(std::abs(at_s) < latest_s) || !std::isfinite(grams))
      return failure(Fault::malformed, source + ": line " + std::to_string(number) +
                                           ": a weighing is host_s,grams: seconds and grams");
    const auto since = std::chrono::duration_cast<Duration>(std::chrono::duration<double>(at_s));
    weighings.push_back({grams, Timestamp(since)});
  }
  if (weighings.empty()) return failure(Fault::malformed, source + " lists no weighing: host_s,grams a line");
  return weighings;
}

Result<std::vector<Weighing>> read_weighings(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return failure(Fault::not_found, file.string() + " cannot be read; give a list of host_s,grams");
  return weighings_from(std::string{std::istreambuf_iterator<char>(in), {}}, file.string());
}

}  // namespace fude
