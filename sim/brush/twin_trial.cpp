#include "sim/brush/twin_trial.h"

#include <algorithm>
#include <cmath>

#include "sim/brush/brush.h"

namespace fude {
namespace {

constexpr double spacing_mm = 0.4;   // of the places
constexpr double blur_mm = 0.5;      // one standard deviation
constexpr double sampling_mm = 0.1;  // of the mark, before it is blurred

Timestamp at_second(double t) {
  return Timestamp(Duration(static_cast<std::int64_t>(std::llround(t * 1e9))));
}

// Weights of samples one `sampling_mm` apart, out to three standard deviations, of sum one.
std::vector<double> gaussian() {
  const int reach = static_cast<int>(3 * blur_mm / sampling_mm);
  std::vector<double> weights;
  double sum = 0;
  for (int i = -reach; i <= reach; ++i) {
    const double x = i * sampling_mm / blur_mm;
    weights.push_back(std::exp(-0.5 * x * x));
    sum += weights.back();
  }
  for (double& w : weights) w /= sum;
  return weights;
}

}  // namespace

TwinMark perform(const BrushSpec& spec, std::span<const HandMoment> hand, double cell_mm) {
  BrushSpec wet = spec;
  wet.cell_mm = cell_mm;
  wet.hair_texture = false;
  wet.split_map = false;
  Brush brush(wet, 1);
  brush.load(1, {1, 0, 0, 0});
  brush.set_endless(true);
  TwinMark made;
  made.mark.cell_mm = cell_mm;
  for (const HandMoment& moment : hand) {
    BrushInput input;
    input.time.host = at_second(moment.t_s);
    input.origin = PoseOrigin::measured;
    input.paper_from_handle = moment.paper_from_handle;
    const BrushFrame frame = brush.move(input);
    if (frame.deposit) made.mark.add(frame.deposit->map);
    if (!frame.solve.converged) ++made.unconverged;
    double force_mn = 0;
    for (const BrushTuft& tuft : brush.state().tufts) {
      const Multipliers& reactions = tuft.state.reactions;
      force_mn += reactions.head(reactions.size() - 1).sum();  // the last is the blocking plane's
    }
    made.force_mn.push_back(force_mn);
  }
  return made;
}

BlurredView::BlurredView(const Mark& seen, double margin_mm)
    : low_(Eigen::Vector2d(seen.left_mm, seen.bottom_mm) - Eigen::Vector2d::Constant(margin_mm)),
      columns_(static_cast<int>(std::ceil((seen.columns * seen.cell_mm + 2 * margin_mm) / spacing_mm))),
      rows_(static_cast<int>(std::ceil((seen.rows * seen.cell_mm + 2 * margin_mm) / spacing_mm))) {}

Eigen::VectorXd BlurredView::of(const Mark& mark) const {
  // Across first, for every sampled line; then up.
  static const std::vector<double> weights = gaussian();
  const int reach = static_cast<int>(weights.size()) / 2;
  const int per_place = static_cast<int>(std::lround(spacing_mm / sampling_mm));
  const int lines = rows_ * per_place + 2 * reach;
  const int samples = columns_ * per_place + 2 * reach;
  Eigen::MatrixXd across(lines, columns_);
  std::vector<double> line(static_cast<std::size_t>(samples));
  for (int j = 0; j < lines; ++j) {
    const double y = low_.y() + (j - reach + 0.5) * sampling_mm;
    for (int i = 0; i < samples; ++i)
      line[static_cast<std::size_t>(i)] = mark.at({low_.x() + (i - reach + 0.5) * sampling_mm, y});
    for (int c = 0; c < columns_; ++c) {
      double sum = 0;
      for (std::size_t k = 0; k < weights.size(); ++k)
        sum += weights[k] * line[static_cast<std::size_t>(c * per_place) + k];
      across(j, c) = sum;
    }
  }
  Eigen::VectorXd places(rows_ * columns_);
  for (int r = 0; r < rows_; ++r)
    for (int c = 0; c < columns_; ++c) {
      double sum = 0;
      for (std::size_t k = 0; k < weights.size(); ++k)
        sum += weights[k] * across(r * per_place + static_cast<int>(k), c);
      places[r * columns_ + c] = sum * spacing_mm;
    }
  return places;
}

namespace {

// Grain of a picture is neither paper nor ink.
double firm(double cover) { return std::clamp(2 * cover - 0.5, 0.0, 1.0); }

}  // namespace

double edge_distance_mm(const Mark& seen, const Mark& made) {
  constexpr double step = 0.1;
  const double left = std::min(seen.left_mm, made.left_mm) - step;
  const double bottom = std::min(seen.bottom_mm, made.bottom_mm) - step;
  const double right =
      std::max(seen.left_mm + seen.columns * seen.cell_mm, made.left_mm + made.columns * made.cell_mm) + step;
  const double top =
      std::max(seen.bottom_mm + seen.rows * seen.cell_mm, made.bottom_mm + made.rows * made.cell_mm) + step;
  const int columns = static_cast<int>(std::ceil((right - left) / step));
  const int rows = static_cast<int>(std::ceil((top - bottom) / step));
  double differing = 0;
  double edge =
      0;  // crossings of the grid's lines, in both directions; an edge of any slope crosses 4/π a step
  std::vector<bool> below(static_cast<std::size_t>(columns), false);
  for (int j = 0; j < rows; ++j) {
    bool before = false;
    for (int i = 0; i < columns; ++i) {
      const Eigen::Vector2d here(left + (i + 0.5) * step, bottom + (j + 0.5) * step);
      const double cover = seen.at(here);
      const bool inside = cover > 0.5;
      differing += std::abs(firm(cover) - firm(made.at(here))) * step * step;
      edge += (inside != before ? step : 0) + (inside != below[static_cast<std::size_t>(i)] ? step : 0);
      before = inside;
      below[static_cast<std::size_t>(i)] = inside;
    }
  }
  constexpr double crossings_per_length = 4 / 3.141592653589793;
  return edge > 0 ? differing / (edge / crossings_per_length) : 0;
}

}  // namespace fude
