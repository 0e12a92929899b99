#include "rig/monitor_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <variant>
#include <vector>

#include "capture/sample_columns.h"

namespace fude {
namespace {

template <class... Values>
std::string formatted(const char* format, Values... values) {
  char text[160];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string as_text(const Cell& cell) {
  struct Visitor {
    std::string operator()(std::monostate) const { return "-"; }
    std::string operator()(std::int64_t value) const { return std::to_string(value); }
    std::string operator()(double value) const { return formatted("%.4g", value); }
    std::string operator()(const std::string& value) const { return value; }
  };
  return std::visit(Visitor{}, cell);
}

std::string values(const Sample& sample) {
  constexpr std::size_t columns_a_line = 2;
  std::string lines;
  std::size_t in_line = 0;
  for (const SampleColumn& column : sample_tables()[sample.index()].columns) {
    lines += formatted("%-24.24s%-15.15s", column.name.c_str(), as_text(column.get(sample)).c_str());
    if (++in_line % columns_a_line == 0) lines += "\n";
  }
  return in_line % columns_a_line == 0 ? lines : lines + "\n";
}

std::string histogram(const StreamFigures& figures) {
  constexpr int widest = 50;
  const std::int64_t most = *std::ranges::max_element(figures.jitter_histogram);
  if (most == 0) return {};
  std::string lines = "distance from the median interval\n";
  for (std::size_t i = 0; i < figures.jitter_histogram.size(); ++i) {
    const std::int64_t count = figures.jitter_histogram[i];
    const auto length = static_cast<std::size_t>((count * widest + most - 1) / most);
    const std::string below = i < jitter_bins_us.size() ? formatted("under %5d us", jitter_bins_us[i])
                                                        : formatted("over  %5d us", jitter_bins_us.back());
    lines += below + formatted(" %8lld ", static_cast<long long>(count)) + std::string(length, '#') + "\n";
  }
  return lines;
}

// The painter's view: right is right, the far side is up.
std::string tilt_dial(Radians tilt_x, Radians tilt_y) {
  constexpr int half_width = 20;
  constexpr int half_height = 6;
  constexpr double edge_degrees = 60;
  const auto place = [](Radians tilt, int half) {
    const double share = std::clamp(in_degrees(tilt) / edge_degrees, -1.0, 1.0);
    return static_cast<int>(std::lround(share * half));
  };
  const int x = place(tilt_x, half_width);
  const int y = place(tilt_y, half_height);
  std::string lines =
      formatted("tilt: %+.0f right, %+.0f towards you, degrees\n", in_degrees(tilt_x), in_degrees(tilt_y));
  for (int row = -half_height; row <= half_height; ++row) {
    std::string line(2 * half_width + 1, row == 0 ? '-' : ' ');
    line[half_width] = row == 0 ? '+' : '|';
    if (row == y) line[static_cast<std::size_t>(half_width + x)] = 'O';
    line.erase(line.find_last_not_of(' ') + 1);
    lines += line + "\n";
  }
  return lines;
}

}  // namespace

std::string monitor_page(const DeviceDescription& device, const std::optional<Sample>& latest,
                         const StreamFigures& figures) {
  std::string page = formatted("%.50s  %.24s\n", device.name.c_str(), device.id.c_str());
  page += formatted("%lld samples, %.1f a second, %lld gaps\n", static_cast<long long>(figures.received),
                    figures.rate_hz, static_cast<long long>(figures.gaps));
  page += formatted("jitter %.0f us, 99 in 100 under %.0f, at most %.0f; to a sample in %.0f us, %.0f\n",
                    figures.jitter_us.p50, figures.jitter_us.p99, figures.jitter_us.largest,
                    figures.delay_us.p50, figures.delay_us.p99);
  if (!latest) return page + "nothing heard yet\n";
  page += "\n" + values(*latest) + "\n" + histogram(figures);
  if (const auto* pen = std::get_if<PenSample>(&*latest); pen != nullptr && pen->tilt_x && pen->tilt_y)
    page += "\n" + tilt_dial(*pen->tilt_x, *pen->tilt_y);
  return page;
}

}  // namespace fude
