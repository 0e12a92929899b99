// The bytes of a camera's recorded pictures, which stand in its transfers.
#pragma once

#include <cstddef>
#include <vector>

#include "capture/session.h"

namespace fude {

class RecordedPictures {
 public:
  // `session` is to outlive this.
  RecordedPictures(const Session& session, DeviceNumber camera);

  // Asked in the order of the recorded frames. Null where the session has the frame and not its bytes.
  const Transfer* of(const CameraFrame& frame);

 private:
  std::vector<const Transfer*> transfers_;
  std::size_t next_ = 0;
};

}  // namespace fude
