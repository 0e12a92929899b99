#include "calibration/pen_mapping.h"

#include <algorithm>
#include <utility>

#include "signal/elementary.h"

namespace fude {
namespace {

constexpr std::uint16_t abs_x = 0;
constexpr std::uint16_t abs_y = 1;

const AxisRange* find_axis(const DeviceDescription& device, std::uint16_t code) {
  for (const AxisRange& axis : device.axes)
    if (axis.code == code) return &axis;
  return nullptr;
}

double counts(const AxisRange& axis) { return double(axis.maximum) - double(axis.minimum); }

double middle(const AxisRange& axis) { return 0.5 * (double(axis.maximum) + double(axis.minimum)); }

// Unit vector along the leaning handle, from its tuft to its upper end.
Eigen::Vector3d leaning_axis(const PenSample& pen) {
  const Eigen::Vector2d slopes = lean_of(pen);
  const Eigen::Vector3d lean(slopes.x(), -slopes.y(), 1);
  return lean / elementary::square_root(lean.squaredNorm());
}

// The shortest rotation that takes z to `axis` (which points upwards).
Eigen::Quaterniond swing_to(const Eigen::Vector3d& axis) {
  const double w = elementary::square_root(0.5 * (1 + axis.z()));
  return Eigen::Quaterniond(w, -axis.y() / (2 * w), axis.x() / (2 * w), 0);
}

}  // namespace

std::optional<Extent> active_area(const DeviceDescription& device) {
  if (device.width && device.height && device.width->value > 0 && device.height->value > 0)
    return Extent{*device.width, *device.height};
  return std::nullopt;
}

Result<TabletMapping> mapping_for(const DeviceDescription& device, Extent sheet) {
  TabletMapping mapping;
  mapping.centre_x_mm = 0.5 * sheet.width.value;
  mapping.centre_y_mm = 0.5 * sheet.height.value;
  const AxisRange* x = find_axis(device, abs_x);
  const AxisRange* y = find_axis(device, abs_y);
  if (device.mm_per_count) {
    mapping.mm_per_count_x = mapping.mm_per_count_y = *device.mm_per_count;
    return mapping;
  }
  const auto area = active_area(device);
  if (!area || !x || !y || counts(*x) <= 0 || counts(*y) <= 0)
    return failure(Fault::unsupported,
                   "the size of '" + device.name + "' is not known; give it with --tablet-mm WxH");
  mapping.mm_per_count_x = area->width.value / counts(*x);
  mapping.mm_per_count_y = area->height.value / counts(*y);
  mapping.centre_x_counts = middle(*x);
  mapping.centre_y_counts = middle(*y);
  return mapping;
}

TabletMapping mapping_by(std::shared_ptr<const TabletSurface> surface, Extent sheet) {
  TabletMapping mapping;
  mapping.centre_x_mm = 0.5 * sheet.width.value;
  mapping.centre_y_mm = 0.5 * sheet.height.value;
  mapping.turn = turn_of(*surface);
  mapping.surface = std::move(surface);
  return mapping;
}

Eigen::Vector2d nib_on_paper(const PenSample& pen, const TabletMapping& m) {
  if (m.surface) {
    const Eigen::Vector2d at = on_paper(*m.surface, pen);
    return {m.centre_x_mm + m.scale * (at.x() - 0.5 * m.surface->width_mm),
            m.centre_y_mm + m.scale * (at.y() - 0.5 * m.surface->height_mm)};
  }
  const double right = m.scale * m.mm_per_count_x * (pen.x_counts - m.centre_x_counts);
  const double away = -m.scale * m.mm_per_count_y * (pen.y_counts - m.centre_y_counts);
  const elementary::SineCosine turn = elementary::sine_cosine(m.turn.value);
  return {m.centre_x_mm + turn.cosine * right - turn.sine * away,
          m.centre_y_mm + turn.sine * right + turn.cosine * away};
}

BrushInput brush_input(const PenSample& pen, const TabletMapping& mapping, const PenReach& reach) {
  BrushInput input;
  input.time = pen.time;
  input.origin = pen.in_proximity ? PoseOrigin::measured : PoseOrigin::none;
  input.in_contact = pen.in_contact;
  input.pressure = pen.pressure;
  input.after_gap = pen.after_gap;

  const Eigen::Vector2d nib = nib_on_paper(pen, mapping);
  const elementary::SineCosine turned = elementary::sine_cosine(mapping.turn.value);
  const Eigen::Vector3d lean = leaning_axis(pen);
  const Eigen::Vector3d axis(turned.cosine * lean.x() - turned.sine * lean.y(),
                             turned.sine * lean.x() + turned.cosine * lean.y(), lean.z());
  const double pressure = std::clamp(pen.pressure.value, 0.0, 1.0);
  const double length = reach.tuft_length.value;
  const double from_nib =
      pen.in_contact ? length * (1 - reach.deepest.value * elementary::power(pressure, reach.exponent))
                     : length + reach.clearance.value / axis.z();
  input.paper_from_handle.translation = Eigen::Vector3d(nib.x(), nib.y(), 0) + from_nib * axis;

  const double roll = 0.5 * (mapping.turn.value - (pen.rotation ? pen.rotation->value : 0.0));
  const elementary::SineCosine half = elementary::sine_cosine(roll);
  input.paper_from_handle.rotation = swing_to(axis) * Eigen::Quaterniond(half.cosine, 0, 0, half.sine);
  return input;
}

}  // namespace fude
