#include "rig/calibration/shown_pictures.h"

#include <utility>
#include <variant>

#include "capture/picture/grey_picture.h"

namespace fude {

Result<std::optional<ShownPicture>> ShownPictures::hear(DeviceNumber device, const Sample& sample,
                                                        const Transfer* picture) {
  const auto mine = camera_.takes(device, sample);
  if (!mine) return tl::unexpected(mine.error());
  if (!*mine) return std::nullopt;
  const std::string name = "picture " + std::to_string(++count_);
  auto image = picture ? grey_picture(picture->payload, std::get<CameraFrame>(sample))
                       : Result<GreyImage>(failure(Fault::not_found, "its bytes are not there"));
  if (image) return ShownPicture{name, std::move(*image)};
  damaged_.push_back(name + " is left out: " + image.error().message);
  return std::nullopt;
}

void ShownPictures::sign(CalibrationReport& report) const {
  if (camera_.chosen()) report.devices = {camera_.chosen()->device.id};
  report.warnings.insert(report.warnings.end(), damaged_.begin(), damaged_.end());
}

}  // namespace fude
