#include "rig/calibration/shown_pictures.h"

#include <utility>

#include "capture/picture/grey_picture.h"

namespace fude {

std::optional<ShownPicture> ShownPictures::next(const CameraFrame& frame, const Transfer* picture) {
  const std::string name = "picture " + std::to_string(++count_);
  auto image = picture ? grey_picture(picture->payload, frame)
                       : Result<GreyImage>(failure(Fault::not_found, "its bytes are not there"));
  if (image) return ShownPicture{name, std::move(*image)};
  damaged_.push_back(name + " is left out: " + image.error().message);
  return std::nullopt;
}

}  // namespace fude
