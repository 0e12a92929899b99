#include "rig/calibrated_tablets.h"

#include <algorithm>
#include <utility>

namespace fude {
namespace {

bool is_of_a_tablet(const StoredCalibration& calibration) {
  return text_in(calibration.result, "shape") == "tablet";
}

}  // namespace

Result<std::vector<CalibratedTablet>> calibrated_tablets(const std::vector<StoredCalibration>& calibrations) {
  std::vector<CalibratedTablet> tablets;
  for (const StoredCalibration& calibration : calibrations) {
    if (!is_of_a_tablet(calibration)) continue;
    auto surface = tablet_surface_from(calibration.result);
    if (!surface)
      return failure(Fault::malformed, "the calibration of the " + calibration.report.from_frame +
                                           " lacks a part; name a whole one with --cal");
    tablets.push_back(
        {calibration.report.devices, std::make_shared<const TabletSurface>(std::move(*surface))});
  }
  return tablets;
}

std::shared_ptr<const TabletSurface> surface_of(const std::vector<CalibratedTablet>& tablets,
                                                const DeviceDescription& device) {
  for (auto tablet = tablets.rbegin(); tablet != tablets.rend(); ++tablet)
    if (std::ranges::find(tablet->devices, device.id) != tablet->devices.end()) return tablet->surface;
  return nullptr;
}

std::optional<Extent> area_of(const std::vector<CalibratedTablet>& tablets, const DeviceDescription& device) {
  if (const auto surface = surface_of(tablets, device))
    return Extent{Millimetres(surface->width_mm), Millimetres(surface->height_mm)};
  return active_area(device);
}

Result<StoredCalibration> tablet_calibration(const std::filesystem::path& file) {
  auto calibration = read_calibration(file);
  if (!calibration) return tl::unexpected(calibration.error());
  if (!is_of_a_tablet(*calibration) || !tablet_surface_from(calibration->result))
    return failure(Fault::usage,
                   file.string() +
                       " is not the calibration of a tablet; make one with fude calibrate surface "
                       "SESSION --taps 5x5 --sheet-mm WxH");
  return calibration;
}

}  // namespace fude
