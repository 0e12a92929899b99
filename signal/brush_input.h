// What moves the brush: the pose of the handle over the paper at one time.
#pragma once

#include "signal/pose.h"
#include "signal/timestamp.h"
#include "signal/units.h"

namespace fude {

struct BrushInput {
  SampleTime time;
  PoseOrigin origin = PoseOrigin::none;   // none: no brush over the paper
  Pose<Paper, Handle> paper_from_handle;  // millimetres
  bool in_contact = false;                // what the device says; the solver finds its own contact
  Fraction pressure;                      // for display; the height of the handle carries it already
  bool after_gap = false;                 // do not sweep from the sample before
};

}  // namespace fude
