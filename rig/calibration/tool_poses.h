// The poses of a tool as they come, as they are or as seen from another tool.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "calibration/report.h"
#include "rig/calibration/stream_choice.h"
#include "signal/pose_history.h"
#include "signal/pose_sample.h"

namespace fude {

struct ToolWish {
  std::string tool;       // empty: the only one, or the only one beside `reference`
  std::string reference;  // its frame stands for the tracker's; empty: the tracker itself
};

class ToolPoses {
 public:
  explicit ToolPoses(const ToolWish& wish);

  void begin(DeviceNumber device, const DeviceDescription& description);

  // The poses that are ready, in their order: at once without a reference, else as soon as the reference was
  // seen at that time or later. Where it was not seen near on both sides, the pose is not valid.
  // Errors: as StreamChoice::takes; usage where another tracker sees the reference.
  Result<std::vector<PoseSample>> hear(DeviceNumber device, const Sample& sample);

  // Those that still waited, at the end. Errors: not_found where tool or reference was never heard.
  Result<std::vector<PoseSample>> rest();

  // None before the first pose of the tool.
  const std::optional<ChosenStream>& tool() const { return tool_.chosen(); }

  // Writes into the report whose it is: of the tool in its own frame, or of the frame that it is seen in, the
  // reference's or the tracker's.
  void sign_tool(CalibrationReport& report) const;
  void sign_frame(CalibrationReport& report) const;

 private:
  PoseSample seen_from_reference(PoseSample sample) const;
  std::vector<PoseSample> ready(Timestamp until);

  StreamChoice tool_;
  std::optional<StreamChoice> reference_;
  PoseHistory history_;             // of the reference
  std::deque<PoseSample> waiting_;  // for the reference
};

}  // namespace fude
