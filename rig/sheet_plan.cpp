#include "rig/sheet_plan.h"

#include <algorithm>
#include <utility>

namespace fude {
namespace {

constexpr double border_mm = 20;  // both sides together
constexpr double smallest_sheet_mm = 1;
constexpr double largest_sheet_mm = 10'000;

// The rectangle of counts that a device's contacts cover; of all its samples where none touches.
struct CountsBox {
  double left = 0, right = 0, top = 0, bottom = 0;
  bool any = false;

  void add(const PenSample& p) {
    left = any ? std::min(left, p.x_counts) : p.x_counts;
    right = any ? std::max(right, p.x_counts) : p.x_counts;
    top = any ? std::min(top, p.y_counts) : p.y_counts;
    bottom = any ? std::max(bottom, p.y_counts) : p.y_counts;
    any = true;
  }
};

CountsBox covered(const Session& session, DeviceNumber device) {
  CountsBox contacts;
  CountsBox all;
  for (const RecordedPen& pen : session.pens) {
    if (pen.device != device || !pen.sample.in_proximity) continue;
    all.add(pen.sample);
    if (pen.sample.in_contact) contacts.add(pen.sample);
  }
  return contacts.any ? contacts : all;
}

}  // namespace

DeviceDescription sized(DeviceDescription device, const std::optional<Extent>& told) {
  if (!told || active_area(device) || device.mm_per_count) return device;
  device.width = told->width;
  device.height = told->height;
  return device;
}

Result<TabletMapping> mapping_on(const SheetPlan& plan, const DeviceDescription& device) {
  if (auto surface = surface_of(plan.calibrated, device)) return mapping_by(std::move(surface), plan.sheet);
  return mapping_for(device, plan.sheet);
}

Result<SheetPlan> plan_sheet(const Session& session, const SheetWish& wish) {
  SheetPlan plan;
  plan.manner = wish.manner;
  std::vector<StoredCalibration> calibrations;
  for (const RecordedCalibration& carried : session.calibrations)
    if (auto calibration = calibration_from_toml(carried.toml, carried.name))
      calibrations.push_back(std::move(*calibration));
  calibrations.insert(calibrations.end(), wish.calibrations.begin(), wish.calibrations.end());
  auto calibrated = calibrated_tablets(calibrations);
  if (!calibrated) return tl::unexpected(calibrated.error());
  plan.calibrated = std::move(*calibrated);
  std::vector<RecordedDevice> painters;
  for (RecordedDevice device : session.devices) {
    if (!covered(session, device.number).any) continue;
    device.description = sized(std::move(device.description), wish.tablet);
    painters.push_back(std::move(device));
  }

  if (!painters.empty() && !wish.calibrations.empty()) {
    const auto named = calibrated_tablets(wish.calibrations);
    const auto its = [&](const RecordedDevice& d) { return surface_of(*named, d.description) != nullptr; };
    if (named && std::ranges::none_of(painters, its))
      return failure(Fault::usage, "the calibration given with --cal was made with another tablet than '" +
                                       painters.front().description.name + "'; calibrate this one");
  }

  for (const RecordedDevice& device : painters) {
    Extent area;
    if (const auto known = area_of(plan.calibrated, device.description)) {
      area = *known;
    } else if (const auto mm = device.description.mm_per_count) {
      const CountsBox box = covered(session, device.number);
      area = {Millimetres((box.right - box.left) * *mm + border_mm),
              Millimetres((box.bottom - box.top) * *mm + border_mm)};
    }
    plan.sheet.width = std::max(plan.sheet.width, area.width);
    plan.sheet.height = std::max(plan.sheet.height, area.height);
  }
  if (wish.sheet) plan.sheet = *wish.sheet;
  if (painters.empty() && !wish.sheet) plan.sheet = {Millimetres(100), Millimetres(100)};

  for (const RecordedDevice& device : painters) {
    auto mapping = mapping_on(plan, device.description);
    if (!mapping) return tl::unexpected(mapping.error());
    if (!mapping->surface && device.description.mm_per_count && !active_area(device.description)) {
      const CountsBox box = covered(session, device.number);
      mapping->centre_x_counts = 0.5 * (box.left + box.right);
      mapping->centre_y_counts = 0.5 * (box.top + box.bottom);
    }
    plan.mappings[device.number] = *mapping;
  }
  for (const Millimetres side : {plan.sheet.width, plan.sheet.height})
    if (!(side.value >= smallest_sheet_mm && side.value <= largest_sheet_mm))
      return failure(Fault::usage,
                     "a sheet must be between 1 mm and 10 m a side; give another --size-mm WxH");
  return plan;
}

}  // namespace fude
