// A camera's frames as pictures, named "picture 1", "picture 2" … in their order.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "signal/camera_frame.h"
#include "signal/grey_image.h"
#include "signal/transfer.h"

namespace fude {

struct ShownPicture {
  std::string name;
  GreyImage image;
};

class ShownPictures {
 public:
  // None where its bytes are not there or are damaged; that is told in damaged().
  std::optional<ShownPicture> next(const CameraFrame& frame, const Transfer* picture);

  const std::vector<std::string>& damaged() const { return damaged_; }

 private:
  std::size_t count_ = 0;
  std::vector<std::string> damaged_;
};

}  // namespace fude
