// A camera's frames as pictures, named "picture 1", "picture 2" … in their order.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/report.h"
#include "rig/calibration/stream_choice.h"
#include "signal/grey_image.h"
#include "signal/result.h"
#include "signal/sample.h"
#include "signal/transfer.h"

namespace fude {

struct ShownPicture {
  std::string name;
  GreyImage image;
};

class ShownPictures {
 public:
  explicit ShownPictures(const std::string& camera)  // empty: the only one
      : camera_({.name = camera, .what = "camera", .kinds = is_kind<CameraFrame>}) {}

  void begin(DeviceNumber device, const DeviceDescription& description) {
    camera_.begin(device, description);
  }

  // None where it is no frame of that camera, or its bytes are not there or are damaged. Errors: as
  // StreamChoice::takes.
  Result<std::optional<ShownPicture>> hear(DeviceNumber device, const Sample& sample,
                                           const Transfer* picture);

  // None before the first frame.
  const std::optional<ChosenStream>& camera() const { return camera_.chosen(); }
  // Errors: not_found where there was none.
  Result<ChosenStream> found() const { return camera_.found(); }

  // Whose the report is, and a warning for each damaged picture.
  void sign(CalibrationReport& report) const;

 private:
  StreamChoice camera_;
  std::size_t count_ = 0;
  std::vector<std::string> damaged_;
};

}  // namespace fude
