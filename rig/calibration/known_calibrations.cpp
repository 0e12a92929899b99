#include "rig/calibration/known_calibrations.h"

#include <algorithm>
#include <utility>

#include "calibration/pivot.h"
#include "rig/calibration/made_with.h"

namespace fude {
namespace {

CalibratedHere here(const ChosenStream& stream, const std::string& reference) {
  return {{stream.device.id}, stream.part, reference};
}

// As one that is kept must be.
bool just_of(const CalibrationReport& report, const ChosenStream& stream, const std::string& reference) {
  return made_otherwise(report, here(stream, reference)).empty() && !may_be_any(stream.device.id) &&
         (report.tool.empty() || report.tool == stream.part) &&
         std::ranges::find(report.devices, stream.device.id) != report.devices.end();
}

std::string named(const ChosenStream& tool) {
  return (tool.part.empty() ? "" : "the tool " + tool.part + " of ") + tool.device.id;
}

}  // namespace

Result<KnownCalibrations> KnownCalibrations::read(const std::vector<std::filesystem::path>& files) {
  KnownCalibrations known;
  for (const std::filesystem::path& file : files) {
    auto calibration = read_calibration(file);
    if (!calibration) return tl::unexpected(calibration.error());
    known.named_.push_back({file.string(), std::move(*calibration)});
  }
  return known;
}

void KnownCalibrations::carry(const Session& session) {
  for (const RecordedCalibration& recorded : session.calibrations)
    if (auto calibration = calibration_from_toml(recorded.toml, recorded.name))
      carried_.push_back(std::move(*calibration));
}

void KnownCalibrations::keep(std::vector<StoredCalibration> current) { kept_ = std::move(current); }

Result<std::optional<StoredCalibration>> KnownCalibrations::find(std::string_view procedure,
                                                                 const ChosenStream& stream,
                                                                 const std::string& reference) const {
  const CalibratedHere sought = here(stream, reference);
  std::optional<Error> other;
  for (const Named& named : named_) {
    if (named.calibration.report.procedure != procedure) continue;
    const std::string against = made_otherwise(named.calibration.report, sought);
    if (against.empty()) return named.calibration;
    other = Error{Fault::malformed, named.file + " was made " + against + "; calibrate this one"};
  }
  if (other) return tl::unexpected(*other);
  const auto carried = std::find_if(carried_.rbegin(), carried_.rend(), [&](const StoredCalibration& c) {
    return c.report.procedure == procedure && made_otherwise(c.report, sought).empty();
  });
  if (carried != carried_.rend()) return *carried;
  const auto kept = std::ranges::find_if(kept_, [&](const StoredCalibration& c) {
    return c.report.procedure == procedure && just_of(c.report, stream, reference);
  });
  if (kept != kept_.end()) return *kept;
  return std::nullopt;
}

std::string KnownCalibrations::others(std::string_view procedure) const {
  for (const auto& [calibrations, where] :
       {std::pair(&carried_, " is in the session"), std::pair(&kept_, " is kept")})
    for (const StoredCalibration& c : *calibrations) {
      if (c.report.procedure != procedure) continue;
      const std::string tool = c.report.tool.empty() ? "" : "of the tool " + c.report.tool + " ";
      return "that " + tool + "of " + (c.report.devices.empty() ? "no device" : c.report.devices.front()) +
             where;
    }
  return {};
}

Result<Eigen::Vector3d> tip_of(std::string_view procedure, const std::optional<Eigen::Vector3d>& named_m,
                               const KnownCalibrations& known, const ChosenStream& tool) {
  if (named_m) return *named_m;
  const auto found = known.find("pivot", tool);
  if (!found) return tl::unexpected(found.error());
  if (*found)
    if (const auto pivot = pivot_from((*found)->result)) return pivot->tip_m;
  const std::string others = known.others("pivot");
  return failure(Fault::usage,
                 std::string(procedure) + " needs the tip: give --cal PIVOT.toml or --tip-mm x,y,z" +
                     (others.empty() ? "" : " (" + others + ", and not that of " + named(tool) + ")"));
}

}  // namespace fude
