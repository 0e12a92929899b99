#include "rig/calibration/landmark_file.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>

namespace fude {
namespace {

constexpr double metres_per_mm = 1e-3;

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::optional<Landmark> landmark_from(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(trimmed(cell));
  if (cells.size() != 4 || cells[0].empty()) return std::nullopt;
  Landmark landmark{cells[0]};
  for (std::size_t i = 0; i < 3; ++i) {
    char* end = nullptr;
    const double value = std::strtod(cells[i + 1].c_str(), &end);
    if (cells[i + 1].empty() || *end != '\0' || !std::isfinite(value)) return std::nullopt;
    landmark.at_m(Eigen::Index(i)) = metres_per_mm * value;
  }
  return landmark;
}

const Landmark* named(const std::vector<Landmark>& landmarks, const std::string& name) {
  const auto found =
      std::find_if(landmarks.begin(), landmarks.end(), [&](const Landmark& l) { return l.name == name; });
  return found == landmarks.end() ? nullptr : &*found;
}

}  // namespace

Result<std::vector<Landmark>> landmarks_from(std::string_view text, const std::string& source) {
  std::vector<Landmark> landmarks;
  std::istringstream in{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    line = trimmed(line.substr(0, line.find('#')));
    if (line.empty()) continue;
    const auto landmark = landmark_from(line);
    if (!landmark && landmarks.empty() && line.starts_with("name,")) continue;  // a heading
    const std::string where = source + ": line " + std::to_string(number) + ": ";
    if (!landmark) return failure(Fault::malformed, where + "a landmark is name,x,y,z in millimetres");
    if (named(landmarks, landmark->name) != nullptr)
      return failure(Fault::malformed, where + "the name " + landmark->name + " stands twice");
    landmarks.push_back(*landmark);
  }
  if (landmarks.empty()) return failure(Fault::malformed, source + " lists no landmark: name,x,y,z a line");
  return landmarks;
}

Result<std::vector<Landmark>> read_landmarks(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return failure(Fault::not_found, file.string() + " cannot be read; give a list of landmarks");
  return landmarks_from(std::string{std::istreambuf_iterator<char>(in), {}}, file.string());
}

std::vector<Eigen::Vector3d> in_order_of(const std::vector<Landmark>& listed,
                                         const std::vector<Landmark>& measured) {
  std::vector<Eigen::Vector3d> by_name, as_they_stand;
  for (const Landmark& landmark : measured) as_they_stand.push_back(landmark.at_m);
  for (const Landmark& landmark : listed)
    if (const Landmark* same = named(measured, landmark.name)) by_name.push_back(same->at_m);
  return by_name.size() == listed.size() && listed.size() == measured.size() ? by_name : as_they_stand;
}

}  // namespace fude
