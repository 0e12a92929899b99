#include "rig/calibration/tablet.h"

#include <cmath>
#include <utility>

#include "calibration/pen_mapping.h"
#include "rig/calibration/landmark_file.h"
#include "rig/calibration/stream_calibrator.h"

namespace fude {
namespace {

constexpr double mm_per_m = 1e3;
constexpr double same_size = 0.03;

// A sheet measured in other units, or a wrong --sheet-mm, shows where the tablet says its own size.
void compare_with_stated_size(CalibrationReport& report, const DeviceDescription& tablet) {
  const auto found = numbers_in(report.details, "mm_per_count");
  const auto stated = mapping_for(tablet, {Millimetres(1), Millimetres(1)});
  if (!found || found->size() != 2 || !stated) return;
  const double wider = (*found)[0] / stated->mm_per_count_x - 1;
  const double higher = (*found)[1] / stated->mm_per_count_y - 1;
  if (std::abs(wider) < same_size && std::abs(higher) < same_size) return;
  const auto percent = [](double share) { return (share < 0 ? "" : "+") + in_words(100 * share, 0) + " %"; };
  report.warnings.push_back("by the taps the tablet differs from the size that it states (" + percent(wider) +
                            " wide, " + percent(higher) + " high): is --sheet-mm as printed or shown?");
}

void sign(CalibrationOutcome& outcome, const DeviceDescription& tablet) {
  outcome.report.from_frame = "tablet " + tablet.name;
  if (outcome.result) compare_with_stated_size(outcome.report, tablet);
}

}  // namespace

std::unique_ptr<Calibrator> tablet_calibrator(TabletWish wish) {
  return std::make_unique<StreamCalibrator<PenSample, TabletProcedure>>(
      std::move(wish.tablet), "tablet", TabletProcedure(std::move(wish.sheet)), sign);
}

Result<TapSheet> listed_taps(const std::filesystem::path& list, double width_mm, double height_mm) {
  const auto places = read_landmarks(list);
  if (!places) return tl::unexpected(places.error());
  TapSheet sheet{.places_mm = {}, .width_mm = width_mm, .height_mm = height_mm};
  for (const Landmark& place : *places) {
    const Eigen::Vector2d mm = mm_per_m * place.at_m.head<2>();
    constexpr double rounding_mm = 0.01;
    if (mm.minCoeff() < -rounding_mm || mm.x() > width_mm + rounding_mm || mm.y() > height_mm + rounding_mm)
      return failure(Fault::usage,
                     list.string() + ": " + place.name +
                         " does not lie on the sheet of --sheet-mm; x and y count from its lower "
                         "left corner, in mm");
    sheet.places_mm.push_back(mm);
  }
  return sheet;
}

}  // namespace fude
