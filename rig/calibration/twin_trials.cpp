#include "rig/calibration/twin_trials.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>

#include "capture/picture/grey_picture.h"

namespace fude {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t pose_cells = 8;
constexpr int least_contrast = 40;  // codes of 255 between paper and ink
constexpr double mn_per_n = 1000;
constexpr double farthest_mm = 10000;

Result<std::string> bytes_of_file(const fs::path& file, const std::string& what) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  if (!in) return failure(Fault::not_found, file.string() + " cannot be read; " + what);
  return bytes;
}

std::optional<std::vector<double>> numbers_of(const std::string& line) {
  std::vector<double> numbers;
  std::istringstream cells(line);
  for (std::string cell; std::getline(cells, cell, ',');) {
    char* end = nullptr;
    const double value = std::strtod(cell.c_str(), &end);
    if (end == cell.c_str() ||
        cell.find_first_not_of(" \t\r", static_cast<std::size_t>(end - cell.c_str())) != std::string::npos ||
        !std::isfinite(value))
      return std::nullopt;
    numbers.push_back(value);
  }
  return numbers;
}

// Width and height stand in the head of every PNG.
std::optional<CameraFrame> frame_of_png(const std::string& bytes) {
  constexpr std::size_t width_at = 16;
  if (bytes.size() < width_at + 8 || bytes.compare(1, 3, "PNG") != 0) return std::nullopt;
  const auto big_endian = [&](std::size_t at) {
    std::int32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
      value = static_cast<std::int32_t>(static_cast<std::uint32_t>(value) << 8 |
                                        static_cast<std::uint8_t>(bytes[at + i]));
    return value;
  };
  CameraFrame frame;
  frame.format = PixelFormat::png;
  frame.width = big_endian(width_at);
  frame.height = big_endian(width_at + 4);
  return frame;
}

Result<TwinTrial> trial_of(const toml::table& row, const fs::path& folder, const std::string& where) {
  const auto text = [&](const char* key) { return row[key].value<std::string>().value_or(""); };
  TwinTrial trial;
  trial.name = text("name");
  const std::string picture = text("picture");
  const std::string hand = text("hand");
  if (picture.empty() || hand.empty())
    return failure(Fault::malformed, where + " needs picture = \"….png\" and hand = \"….csv\"");
  if (trial.name.empty()) trial.name = fs::path(picture).stem().string();
  std::array<double, 3> place{};
  constexpr std::array keys{"mm_per_pixel", "left_mm", "bottom_mm"};
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto value = row[keys[i]].value<double>();
    if (!value || !(std::abs(*value) <= farthest_mm))
      return failure(Fault::malformed, where + " needs " + keys[i] + ", a number of millimetres");
    place[i] = *value;
  }
  if (!(place[0] >= 0.005 && place[0] <= 1))
    return failure(Fault::malformed, where + ": mm_per_pixel is from 0.005 to 1");

  const auto moments = bytes_of_file(folder / hand, "name the poses of the trial");
  if (!moments) return tl::unexpected(moments.error());
  auto led = hand_from(*moments, (folder / hand).string());
  if (!led) return tl::unexpected(led.error());
  trial.hand = std::move(*led);

  const auto png = bytes_of_file(folder / picture, "name the picture of the mark");
  if (!png) return tl::unexpected(png.error());
  const auto frame = frame_of_png(*png);
  if (!frame) return failure(Fault::malformed, (folder / picture).string() + " is no PNG");
  const auto grey = grey_picture(std::as_bytes(std::span(*png)), *frame);
  if (!grey) return failure(grey.error().fault, (folder / picture).string() + ": " + grey.error().message);
  auto mark = mark_in(*grey, place[0], place[1], place[2], (folder / picture).string());
  if (!mark) return tl::unexpected(mark.error());
  trial.seen = std::move(*mark);
  return trial;
}

}  // namespace

Result<std::vector<HandMoment>> hand_from(std::string_view text, const std::string& source) {
  std::vector<HandMoment> hand;
  std::istringstream in{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    line.erase(std::min(line.find('#'), line.size()));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    if (hand.empty() && line.starts_with("t_s")) continue;  // a heading
    const auto bad = [&](const std::string& why) {
      return failure(Fault::malformed, source + ": line " + std::to_string(number) + ": " + why);
    };
    const auto cells = numbers_of(line);
    if (!cells || cells->size() < pose_cells || cells->size() > pose_cells + 1)
      return bad("a moment is t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz and, where it was measured, force_n");
    const std::vector<double>& c = *cells;
    HandMoment moment;
    moment.t_s = c[0];
    moment.paper_from_handle.translation = {c[1], c[2], c[3]};
    moment.paper_from_handle.rotation = Eigen::Quaterniond(c[4], c[5], c[6], c[7]);
    if (std::abs(moment.paper_from_handle.rotation.norm() - 1) > 0.02)
      return bad("qw,qx,qy,qz is no rotation: its squares add up to one");
    moment.paper_from_handle.rotation.normalize();
    if (moment.paper_from_handle.translation.cwiseAbs().maxCoeff() > farthest_mm)
      return bad("the handle is more than 10 m away: places are in millimetres");
    if (c.size() > pose_cells) moment.force_mn = mn_per_n * c[pose_cells];
    if (!hand.empty() && moment.t_s <= hand.back().t_s) return bad("time runs backwards");
    hand.push_back(moment);
  }
  if (hand.size() < 10)
    return failure(Fault::malformed, source + " has fewer than ten moments of the gesture");
  return hand;
}

Result<Mark> mark_in(const GreyImage& picture, double mm_per_pixel, double left_mm, double bottom_mm,
                     const std::string& source) {
  std::array<std::size_t, 256> counts{};
  for (const std::uint8_t code : picture.pixels) ++counts[code];
  const auto code_at = [&](double share) {
    std::size_t below = 0;
    int code = 0;
    while (code < 255 && static_cast<double>(below += counts[static_cast<std::size_t>(code)]) <=
                             share * static_cast<double>(picture.pixels.size()))
      ++code;
    return code;
  };
  // A seventh of a picture at least is paper; a light touch covers a hundredth of it.
  const int paper = code_at(0.85);
  const int ink = code_at(0.002);
  if (paper - ink < least_contrast)
    return failure(Fault::malformed,
                   source + " shows no mark: the darkest ink is hardly darker than the paper");
  Mark mark{left_mm, bottom_mm, mm_per_pixel, picture.width, picture.height, {}};
  for (int row = picture.height - 1; row >= 0; --row)
    for (int column = 0; column < picture.width; ++column) {
      const int code =
          picture.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) +
                         static_cast<std::size_t>(column)];
      // What is within a tenth of the paper is paper.
      const double cover = (0.9 * paper + 0.1 * ink - code) / (0.8 * (paper - ink));
      mark.covered.push_back(static_cast<float>(std::clamp(cover, 0.0, 1.0)));
    }
  const auto covered = [&](int column, int row) {
    return mark.covered[static_cast<std::size_t>(row) * static_cast<std::size_t>(mark.columns) +
                        static_cast<std::size_t>(column)] > 0.5F;
  };
  int at_edge = 0;
  for (int c = 0; c < mark.columns; ++c) at_edge += covered(c, 0) + covered(c, mark.rows - 1);
  for (int r = 0; r < mark.rows; ++r) at_edge += covered(0, r) + covered(mark.columns - 1, r);
  if (at_edge > 0.01 * (mark.columns + mark.rows))
    return failure(Fault::malformed,
                   source + ": the mark runs out of the picture; leave paper all around it");
  return mark;
}

Result<std::vector<TwinTrial>> read_twin_trials(const fs::path& folder) {
  const fs::path list = folder / "trials.toml";
  const auto text = bytes_of_file(list, "a folder of trials has a trials.toml (docs/calibration.md)");
  if (!text) return tl::unexpected(text.error());
  toml::table table;
  try {
    table = toml::parse(*text);
  } catch (const toml::parse_error& e) {
    return failure(Fault::malformed, list.string() + ", line " + std::to_string(e.source().begin.line) +
                                         ": " + std::string(e.description()));
  }
  const toml::array* rows = table["trial"].as_array();
  if (rows == nullptr || rows->empty())
    return failure(Fault::malformed, list.string() + " lists no [[trial]]");
  std::vector<TwinTrial> trials;
  for (const toml::node& row : *rows) {
    const std::string where = list.string() + ", trial " + std::to_string(trials.size() + 1);
    if (!row.is_table()) return failure(Fault::malformed, where + " is no table");
    auto trial = trial_of(*row.as_table(), folder, where);
    if (!trial) return tl::unexpected(trial.error());
    trials.push_back(std::move(*trial));
  }
  return trials;
}

}  // namespace fude
