// Two tools at once, of one tracker or of two.
#pragma once

#include <string>

#include "calibration/report.h"
#include "rig/calibration/stream_choice.h"
#include "signal/pose_sample.h"

namespace fude {

class TwoTools {
 public:
  // `tool` empty: the only one beside `other`.
  TwoTools(const std::string& tool, const std::string& other);

  void begin(DeviceNumber device, const DeviceDescription& description);

  // The pose, where it is of one of the two. Errors: as StreamChoice::takes.
  struct Heard {
    const PoseSample* of_tool = nullptr;
    const PoseSample* of_other = nullptr;
  };
  Result<Heard> hear(DeviceNumber device, const Sample& sample);

  // Errors: not_found where one of them was never heard.
  Result<void> found() const;

  // Whose the result is: of the tool, and made with both devices; or of the tool's tracker alone, whatever it
  // sees, unless the same one sees the other tool too.
  void sign(CalibrationReport& report) const;
  void sign_tracker(CalibrationReport& report) const;

 private:
  StreamChoice tool_, other_;
};

}  // namespace fude
