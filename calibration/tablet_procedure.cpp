#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "calibration/tablet_surface.h"
#include "calibration/tap_fit.h"

namespace fude {
namespace {

constexpr std::size_t fewest_places = 9;
constexpr double narrowest_share = 0.05;  // standard deviation across, of that along
constexpr double still_mm = 1;            // a tap that wanders more was drawn
constexpr double most_off = 0.25;
constexpr double worst_rms_mm = 2;
constexpr double worst_held_out_mm = 3;
constexpr double fair_rms_mm = 0.5;
constexpr double same_share = 0.2;  // of the distance to the nearest place: two taps this near are on one
constexpr double explains = 0.3;    // of the residual, that another order leaves to be believed

using Points = std::vector<Eigen::Vector2d>;

// Standard deviations along and across.
Eigen::Vector2d spread(const Points& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) mean += p / double(points.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : points)
    scatter += (p - mean) * (p - mean).transpose() / double(points.size());
  const Eigen::Vector2d squares = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(scatter).eigenvalues();
  return {std::sqrt(std::max(0.0, squares(1))), std::sqrt(std::max(0.0, squares(0)))};
}

double nearest_distance(const Points& points) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) least = std::min(least, (points[i] - points[j]).norm());
  return least;
}

std::string numbered(std::size_t index) { return "tap " + std::to_string(index + 1); }

std::string at_place(const Eigen::Vector2d& place) {
  return "(" + in_words(place.x(), 0) + ", " + in_words(place.y(), 0) + ") mm";
}

std::string both_numbered(std::size_t a, std::size_t b) {
  return "taps " + std::to_string(std::min(a, b) + 1) + " and " + std::to_string(std::max(a, b) + 1);
}

double rms_of(const TapFit& fit, std::size_t n) { return std::sqrt(fit.sum_mm2 / double(n)); }

// Other orders in which people go through a grid; mirrored and turned ones fit as well as the right one.
std::vector<std::pair<std::string, std::vector<std::size_t>>> other_orders(const TapSheet& sheet) {
  std::vector<std::pair<std::string, std::vector<std::size_t>>> orders;
  const auto columns = std::size_t(sheet.columns);
  if (columns == 0) return orders;
  const std::size_t rows = sheet.places_mm.size() / columns;
  std::vector<std::size_t> by_columns, winding, by_columns_winding;
  for (std::size_t c = 0; c < columns; ++c)
    for (std::size_t r = 0; r < rows; ++r) {
      by_columns.push_back(r * columns + c);
      by_columns_winding.push_back((c % 2 == 0 ? r : rows - 1 - r) * columns + c);
    }
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c)
      winding.push_back(r * columns + (r % 2 == 0 ? c : columns - 1 - c));
  return {{"column by column", by_columns},
          {"to and fro", winding},
          {"column by column, to and fro", by_columns_winding}};
}

// A cause for places that do not fit, found by trying it.
std::optional<std::string> wrong_order(const TapSheet& sheet, const std::vector<Tap>& taps, TapModel model) {
  const double rms = rms_of(fit_taps(taps, model), taps.size());
  const auto believed = [&](const std::vector<Tap>& trial) {
    return rms_of(fit_taps(trial, model), trial.size()) < std::min(worst_rms_mm, explains * rms);
  };
  if (taps.size() != sheet.places_mm.size()) return std::nullopt;
  std::vector<Tap> trial = taps;
  for (const auto& [name, order] : other_orders(sheet)) {
    for (std::size_t i = 0; i < trial.size(); ++i) trial[i].place_mm = sheet.places_mm[order[i]];
    if (believed(trial)) return "the taps go " + name + ": tap row by row, each from the left";
  }
  trial = taps;
  for (std::size_t i = 0; i < trial.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      std::swap(trial[i].place_mm, trial[j].place_mm);
      if (believed(trial)) return both_numbered(i, j) + " are exchanged";
      std::swap(trial[i].place_mm, trial[j].place_mm);
    }
  return std::nullopt;
}

std::optional<std::string> wrong_with(const Points& places) {
  if (places.size() < fewest_places)
    return "only " + std::to_string(places.size()) +
           " places are listed: nine are the fewest, 25 show a bent surface";
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if ((places[i] - places[j]).norm() < 1e-6)
        return "places " + std::to_string(j + 1) + " and " + std::to_string(i + 1) +
               " of the list are the same";
  if (const Eigen::Vector2d wide = spread(places); wide(1) < narrowest_share * wide(0))
    return "all places lie on one line: list some all over the sheet";
  return std::nullopt;
}

// Before any fit.
std::optional<std::string> wrong_with(const std::vector<PenPress>& presses, const Points& places) {
  Points tapped;
  for (const PenPress& press : presses) tapped.push_back(press.counts);
  const Eigen::Vector2d wide = tapped.empty() ? Eigen::Vector2d(0, 0) : spread(tapped);
  if (tapped.size() > 1 && wide(0) == 0)
    return "all taps are on one spot: the tablet is frozen, or the pen was never moved";
  const double mm_a_count = wide(0) > 0 ? spread(places)(0) / wide(0) : 0;
  std::string repeated;
  const double one_place_mm = same_share * nearest_distance(places);
  for (std::size_t i = 0; i < tapped.size() && repeated.empty(); ++i)
    for (std::size_t j = 0; j < i && repeated.empty(); ++j)
      if (mm_a_count * (tapped[i] - tapped[j]).norm() < one_place_mm)
        repeated = both_numbered(i, j) + " are on one place";
  if (tapped.size() != places.size())
    return std::to_string(tapped.size()) + " taps for " + std::to_string(places.size()) +
           " places: tap each once, in their order, for a quarter of a second" +
           (repeated.empty() ? "" : " (" + repeated + ")");
  if (wide(1) < narrowest_share * wide(0))
    return "all taps lie on one line: the places were not tapped, or one axis is frozen";
  if (!repeated.empty()) return repeated + ": tap each once, in their order";
  std::vector<std::string> drawn;
  for (std::size_t i = 0; i < presses.size(); ++i)
    if (const double mm = mm_a_count * presses[i].wandered_counts.norm(); mm > still_mm)
      drawn.push_back(numbered(i) + " by " + in_words(mm, 1) + " mm");
  if (drawn.empty()) return std::nullopt;
  return "the pen did not rest: it wandered at " + drawn.front() +
         (drawn.size() > 1 ? ", and at " + std::to_string(drawn.size() - 1) + " more" : "") +
         "; put it down, hold it still, lift it";
}

Eigen::Vector2d middle_of(const std::vector<Tap>& taps) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Tap& tap : taps) sum += tap.counts;
  return sum / double(taps.size());
}

void judge(CalibrationReport& report, const RobustTaps& robust) {
  const TabletSurface& surface = robust.fit.surface;
  std::vector<double> distances, left_out;
  for (const Tap& tap : robust.used)
    distances.push_back((on_paper(surface, tap.counts, tap.lean) - tap.place_mm).norm());
  for (Eigen::Index i = 0; i < robust.left_out.rows(); ++i) left_out.push_back(robust.left_out.row(i).norm());
  summarise(report, distances, 2);
  report.held_out_rms = root_mean_square(left_out);
  // Of two coordinates 95 in 100 lie within 2.45 standard deviations of one (Rayleigh's distribution).
  const double n = double(robust.used.size()), freedom = robust.fit.freedom;
  const double deviation = std::sqrt(robust.fit.sum_mm2 / std::max(1.0, 2 * n - freedom));
  report.ci95 = {0, 2.45 * deviation * std::sqrt(freedom / (2 * n))};
  report.detail("degrees_of_freedom", freedom);
  const Eigen::Matrix2d count = mm_per_count(surface, middle_of(robust.used));
  report.detail("mm_per_count", std::vector{count.col(0).norm(), count.col(1).norm()});
  report.detail("lean_mm", std::vector{surface.lean_counts.x() * count.col(0).norm(),
                                       surface.lean_counts.y() * count.col(1).norm()});
  if (!surface.warp) return;
  double most = 0;
  for (const Tap& tap : robust.used) most = std::max(most, surface.warp->at(tap.place_mm.transpose()).norm());
  report.detail("most_warp_mm", most);
}

std::vector<std::string> bad_taps(const RobustTaps& robust, const std::vector<Tap>& taps) {
  std::vector<std::string> bad;
  for (std::size_t i = 0; i < taps.size(); ++i) {
    const Tap& tap = taps[i];
    if (robust.agrees[i]) continue;
    const double off = (on_paper(robust.fit.surface, tap.counts, tap.lean) - tap.place_mm).norm();
    bad.push_back(numbered(i) + " at " + at_place(tap.place_mm) + ", " + in_words(off, 1) + " mm off");
  }
  return bad;
}

}  // namespace

TapSheet tap_grid(int columns, int rows, double width_mm, double height_mm) {
  TapSheet sheet{.places_mm = {}, .width_mm = width_mm, .height_mm = height_mm, .columns = columns};
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      sheet.places_mm.emplace_back(width_mm * c / (columns - 1), height_mm * (rows - 1 - r) / (rows - 1));
  return sheet;
}

Progress TabletProcedure::add(const PenSample& sample) {
  ++samples_;
  listener_.add(sample);
  const std::size_t done = listener_.presses().size(), all = sheet_.places_mm.size();
  if (done >= all) return {samples_, 1, ""};
  return {samples_, double(done) / double(all),
          "tap place " + std::to_string(done + 1) + " of " + std::to_string(all) + ", at " +
              at_place(sheet_.places_mm[done])};
}

Calibration<TabletSurface> TabletProcedure::finish() const {
  CalibrationReport report;
  report.procedure = "surface";
  report.to_frame = "paper";
  report.from_frame = "tablet";
  report.detail("from", std::string("taps"));
  const Points& places = sheet_.places_mm;
  const std::vector<PenPress> presses = listener_.all();
  report.n = presses.size();
  if (auto wrong = wrong_with(places)) return refusal(report, *wrong);
  if (auto wrong = wrong_with(presses, places)) return refusal(report, *wrong);

  std::vector<Tap> taps;
  for (std::size_t i = 0; i < presses.size(); ++i)
    taps.push_back({presses[i].counts, presses[i].lean, places[i]});
  RobustTaps robust = robust_taps(taps);
  TabletSurface& surface = robust.fit.surface;
  surface.width_mm = sheet_.width_mm;
  surface.height_mm = sheet_.height_mm;
  judge(report, robust);
  const std::vector<std::string> bad = bad_taps(robust, taps);
  report.detail("outliers", bad);

  const bool too_many_off = double(bad.size()) > most_off * double(taps.size());
  const TapModel simple{.lean = robust.leaned};
  if (report.rms > worst_rms_mm || bad.size() > 1)
    if (const auto order = wrong_order(sheet_, taps, simple)) return refusal(report, *order);
  if (report.rms > worst_rms_mm || too_many_off)
    return refusal(report, "residual " + in_words(rms_of(fit_taps(taps, simple), taps.size()), 1) +
                               " mm: other places than those listed, another order, or a tablet that moved");
  if (mm_per_count(surface, middle_of(taps)).determinant() > 0)
    return refusal(report,
                   sheet_.columns > 0
                       ? "mirrored, or column by column: tap each row from the left, the upper row first"
                       : "mirrored: the list's x grows to the right and its y away from the painter");
  if (*report.held_out_rms > worst_held_out_mm)
    return refusal(report, "a tap that is left out is foretold " + in_words(*report.held_out_rms, 1) +
                               " mm off: tap more places");
  const double turn_deg = in_degrees(turn_of(surface));
  report.detail("turn_deg", turn_deg);
  if (std::abs(turn_deg) > 45)
    report.warnings.push_back("the tablet lies turned by " + in_words(turn_deg, 0) +
                              " degrees: were the places tapped from the upper left?");
  if (!bad.empty())
    report.warnings.push_back("left out: " + bad.front() +
                              (bad.size() > 1 ? " and " + std::to_string(bad.size() - 1) + " more" : ""));
  if (report.rms > fair_rms_mm)
    report.warnings.push_back("residual " + in_words(report.rms) + " mm: aim at the middle of each mark");
  if (presses.front().tells_tilt && !robust.leaned)
    report.warnings.push_back(
        "the pen hardly leaned: where ink strays as it leans, tap with the pen leaning this way and that");
  report.accepted = true;
  report.reason = std::string(surface.warp ? "a bent tablet" : "a flat tablet") +
                  (robust.model.lean ? " with a shift as the pen leans" : "") + ", known to within " +
                  in_words((*report.ci95)[1]) + " mm (95 %)";
  return Calibrated<TabletSurface>{surface, report};
}

}  // namespace fude
