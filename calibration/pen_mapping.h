// From a pen on a tablet to a brush over the paper: counts to millimetres, pressure to the height of
// the handle, tilt and rotation to its orientation. One stated convention for every device.
#pragma once

#include <memory>
#include <optional>

#include "calibration/tablet_surface.h"
#include "signal/brush_input.h"
#include "signal/device.h"
#include "signal/pen_sample.h"
#include "signal/result.h"
#include "signal/units.h"

namespace fude {

// Tablet to paper: true millimetres, so the aspect is kept. The tablet's y grows towards the painter,
// the paper's away from the painter. `centre_*_counts` lies on `centre_*_mm`; `turn` turns the tablet
// about that point, counter-clockwise as seen from above.
struct TabletMapping {
  double mm_per_count_x = 1;
  double mm_per_count_y = 1;
  double centre_x_counts = 0;
  double centre_y_counts = 0;
  double centre_x_mm = 0;
  double centre_y_mm = 0;
  Radians turn;
  double scale = 1;  // 1: a millimetre of the hand is a millimetre on the paper
  // Of a tablet that was calibrated: it gives the millimetres, and `turn` and the counts above do not. Its
  // middle lies on `centre_*_mm`; `turn` is then how the tablet lies on it.
  std::shared_ptr<const TabletSurface> surface;
};

// The sides of a sheet or of a tablet.
struct Extent {
  Millimetres width;
  Millimetres height;
};

// The active area of a tablet, where its description states one.
std::optional<Extent> active_area(const DeviceDescription& device);

// The middle of the tablet's active area on the middle of the sheet.
// Errors: unsupported where neither axes nor description give millimetres: name a size.
Result<TabletMapping> mapping_for(const DeviceDescription& device, Extent sheet);

// The middle of the calibrated sheet on the middle of the sheet. `surface`: not null.
TabletMapping mapping_by(std::shared_ptr<const TabletSurface> surface, Extent sheet);

// Pen pressure to brush. The pen's nib marks where the handle's axis meets the paper. At pressure p
// the root of the tuft stands `tuft_length · (1 − deepest · p^exponent)` from there along the axis;
// a pen that does not touch holds it `clearance` further off than an unbent tuft reaches.
struct PenReach {
  Millimetres tuft_length;
  Fraction deepest{0.3};
  double exponent = 0.8;
  Millimetres clearance{2};
};

// The handle leans as the pen does: tilt_x > 0 leans its upper end to +x, tilt_y > 0 towards the
// painter (−y); rotation > 0 turns it clockwise seen from above. The orientation is the shortest turn
// from upright to the leaning axis after the turn about the axis. Tilts beyond 80° count as 80°; a pen
// without tilt stands upright. Origin `none` where the pen is out of proximity.
BrushInput brush_input(const PenSample& pen, const TabletMapping& mapping, const PenReach& reach);

// The nib on the paper, millimetres.
Eigen::Vector2d nib_on_paper(const PenSample& pen, const TabletMapping& mapping);

}  // namespace fude
