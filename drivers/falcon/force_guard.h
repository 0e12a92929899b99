// What stands between whoever wants a force and the motors: never without a number, never above the limit,
// never in a jerk, and gone when nobody renews it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "signal/timestamp.h"

namespace fude::falcon {

class ForceGuard {
 public:
  struct Options {
    double limit_n = 8.0;                              // of the device
    double slew_nps = 2000;                            // of the force's change: full force in 4 ms
    Duration holds = std::chrono::milliseconds(10);    // a command stands this long, then fades
    Duration expires = std::chrono::milliseconds(20);  // until it is exactly zero
  };

  ForceGuard() = default;
  explicit ForceGuard(Options options) : options_(options) {}

  // A force that is no number is none: the guard goes to zero until the next.
  void command(const Eigen::Vector3d& force_n, Timestamp at);

  // At most limit_n long, nearer to the command than last time by at most the slew, and zero from `expires`
  // after the last command on. A time that goes back changes nothing but may only weaken the force.
  Eigen::Vector3d force_at(Timestamp now);

  // Zero at once.
  void release();

  std::uint64_t refused() const { return refused_; }

 private:
  Options options_;
  Eigen::Vector3d wanted_n_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d given_n_ = Eigen::Vector3d::Zero();
  std::optional<Timestamp> commanded_;
  std::optional<Timestamp> given_at_;
  std::uint64_t refused_ = 0;
};

}  // namespace fude::falcon
