#include "rig/arm_on_paper.h"

#include <algorithm>
#include <optional>

namespace fude {
namespace {

// The arm's z points to the painter, the paper's y away.
Eigen::Vector3d paper_axes(const Eigen::Vector3d& arm) { return {arm.x(), -arm.z(), arm.y()}; }
Eigen::Vector3d arm_axes(const Eigen::Vector3d& paper) { return {paper.x(), paper.z(), -paper.y()}; }

}  // namespace

Pose<Paper, Handle> paper_from_grip(const HapticSample& sample, const ArmPlace& place) {
  return {Eigen::Quaterniond::Identity(), place.middle_mm + 1e3 * paper_axes(sample.position_m)};
}

falcon::HapticLoop::Feel feel_of(Newest<ContactModel>& models, const ArmPlace& place) {
  return [&models, place](const HapticSample& sample) -> std::optional<Eigen::Vector3d> {
    const auto wrench = felt(models.look(), paper_from_grip(sample, place), sample.time.host);
    if (!wrench) return std::nullopt;
    Eigen::Vector3d force = wrench->force_n;
    if (force.z() > 0)
      force.z() = std::max(0.0, force.z() - paper_damping_ns_per_m * paper_axes(sample.velocity_mps).z());
    return arm_axes(force);
  };
}

ContactModel paper_plane(double touching_mm, Timestamp valid_until) {
  ContactModel model;
  model.paper_from_handle.translation.z() = touching_mm;
  model.stiffness(2, 2) = paper_stiffness_n_per_mm;
  model.valid_until = valid_until;
  return model;
}

}  // namespace fude
