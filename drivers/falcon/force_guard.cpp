#include "drivers/falcon/force_guard.h"

#include <algorithm>

namespace fude::falcon {
namespace {

Eigen::Vector3d held(const Eigen::Vector3d& force, double longest) {
  const double length = force.stableNorm();
  if (!(length > longest)) return force;
  return force * (longest / length);
}

}  // namespace

void ForceGuard::command(const Eigen::Vector3d& force_n, Timestamp at) {
  if (!force_n.allFinite()) {
    ++refused_;
    wanted_n_.setZero();
  } else {
    // Divided first: the length of a huge vector is no number.
    const double largest = force_n.cwiseAbs().maxCoeff();
    wanted_n_ = largest > options_.limit_n ? held(force_n / largest * options_.limit_n, options_.limit_n)
                                           : held(force_n, options_.limit_n);
  }
  commanded_ = at;
}

Eigen::Vector3d ForceGuard::force_at(Timestamp now) {
  const double passed_s = given_at_ ? std::max(0.0, seconds(now - *given_at_)) : 0;
  given_at_ = given_at_ ? std::max(*given_at_, now) : now;

  double share = 0;
  if (commanded_) {
    const double age_s = seconds(now - *commanded_);
    const double holds_s = seconds(options_.holds);
    const double expires_s = seconds(options_.expires);
    share = age_s >= expires_s ? 0 : std::clamp((expires_s - age_s) / (expires_s - holds_s), 0.0, 1.0);
  }
  if (share == 0) {
    given_n_.setZero();
    return given_n_;
  }
  given_n_ += held(wanted_n_ - given_n_, options_.slew_nps * passed_s);
  given_n_ = held(given_n_, options_.limit_n * share);
  return given_n_;
}

void ForceGuard::release() {
  wanted_n_.setZero();
  given_n_.setZero();
  commanded_.reset();
}

}  // namespace fude::falcon
