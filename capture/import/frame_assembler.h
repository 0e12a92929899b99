// Collects single input events into whole frames: the unit of flow is the SYN_REPORT, so no later
// stage sees half a pen state.
#pragma once

#include <vector>

#include "capture/import/recording.h"
#include "signal/result.h"
#include "signal/timestamp.h"
#include "signal/transfer.h"

namespace fude {

class FrameAssembler {
 public:
  // `where` names the place in the file for the error ("line 12").
  // Errors: malformed when a frame is stamped before the one before it.
  Result<void> add(Duration time, const EvdevEvent& event, const std::string& where);

  // The transfers and counts so far.
  // Errors: malformed when three frames or more all carry one time.
  Result<RawRecording> finish(std::optional<DeviceDescription> device) &&;

 private:
  RawRecording recording_;
  std::vector<EvdevEvent> frame_;
};

}  // namespace fude
