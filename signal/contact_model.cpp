#include "signal/contact_model.h"

namespace fude {

std::optional<Wrench> felt(const ContactModel& model, const Pose<Paper, Handle>& paper_from_handle,
                           Timestamp at) {
  if (at > model.valid_until) return std::nullopt;
  // Twice the vector part of the shorter way round: the rotation vector to second order, where the law itself
  // is of first.
  Eigen::Quaterniond turn = paper_from_handle.rotation * model.paper_from_handle.rotation.conjugate();
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  Eigen::Matrix<double, 6, 1> offset;
  offset << paper_from_handle.translation - model.paper_from_handle.translation, 2 * turn.vec();
  const Eigen::Matrix<double, 6, 1> change = model.stiffness * offset;
  const Wrench wrench{model.wrench.force_n - change.head<3>(), model.wrench.torque_nmm - change.tail<3>()};
  return wrench.force_n.z() > 0 ? wrench : Wrench();
}

}  // namespace fude
