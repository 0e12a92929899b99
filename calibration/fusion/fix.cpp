#include "calibration/fusion/fix.h"

#include <cmath>

namespace fude {
namespace {

using Rows3 = Eigen::Matrix<double, 3, error::size>;

// How a point of the sensor's body moves with the state's error.
Rows3 point_jacobian(const MotionState& state, const Eigen::Vector3d& offset) {
  Rows3 j = Rows3::Zero();
  j.middleCols<3>(error::position).setIdentity();
  j.middleCols<3>(error::turn) = -cross_matrix(state.world_from_sensor * (state.lever_m + offset));
  j.middleCols<3>(error::lever) = state.world_from_sensor.toRotationMatrix();
  return j;
}

Eigen::Vector3d point_of(const MotionState& state, const Eigen::Vector3d& offset) {
  return state.tracked_point_m() + state.world_from_sensor * offset;
}

// Height of the surface under a place, and its slope along x and y.
struct Height {
  double m = 0, slope_x = 0, slope_y = 0;
};
Height height_at(const ContactFix& fix, const Eigen::Vector3d& place_m) {
  if (!fix.sheet) return {.m = fix.height_m};
  const Eigen::RowVector2d at_mm = 1e3 * place_m.head<2>().transpose();
  const Eigen::MatrixXd slope = fix.sheet->slope(at_mm);
  return {.m = fix.height_m + 1e-3 * fix.sheet->at(at_mm)(0), .slope_x = slope(0, 0), .slope_y = slope(1, 0)};
}

// Of the tracked point: its place in the sensor's frame and the tracker's lag are being found too.
void tracked_point(const MotionState& state, const Eigen::Vector3d& rate, double assumed_lag_s,
                   const Eigen::Vector3d& seen, Innovation& out) {
  const Eigen::Vector3d velocity = state.velocity_mps + state.world_from_sensor * rate.cross(state.lever_m);
  out.residual.head<3>() = seen - (state.tracked_point_m() - velocity * (state.lag_s - assumed_lag_s));
  out.jacobian.topRows<3>() = point_jacobian(state, Eigen::Vector3d::Zero());
  out.jacobian.block<3, 1>(0, error::lag) = -velocity;
}

void one_row(Innovation& out, const Eigen::Vector3d& direction, const Rows3& point, double residual,
             double sigma) {
  out.rows = 1;
  out.residual[0] = residual;
  out.jacobian.row(0) = direction.transpose() * point;
  out.noise(0, 0) = sigma * sigma;
}

struct Linearise {
  const MotionState& state;
  const Eigen::Vector3d& rate;
  double assumed_lag_s;

  Innovation operator()(const PointFix& fix) const {
    Innovation out;
    out.rows = 3;
    if (fix.offset_m) {
      out.residual.head<3>() = fix.point_m - point_of(state, *fix.offset_m);
      out.jacobian.topRows<3>() = point_jacobian(state, *fix.offset_m);
    } else {
      tracked_point(state, rate, assumed_lag_s, fix.point_m, out);
    }
    out.noise.topLeftCorner<3, 3>() = fix.covariance_m2;
    return out;
  }

  Innovation operator()(const PoseFix& fix) const {
    Innovation out;
    out.rows = 6;
    tracked_point(state, rate, assumed_lag_s, fix.point_m, out);
    const Eigen::Vector3d turning = state.world_from_sensor * rate;
    out.residual.tail<3>() = turn_of(fix.world_from_sensor * state.world_from_sensor.conjugate()) +
                             turning * (state.lag_s - assumed_lag_s);
    out.jacobian.block<3, 3>(3, error::turn).setIdentity();
    out.jacobian.block<3, 1>(3, error::lag) = -turning;
    out.noise = fix.covariance;
    return out;
  }

  Innovation operator()(const RangeFix& fix) const {
    Innovation out;
    const Eigen::Vector3d path = point_of(state, fix.emitter_offset_m) - fix.receiver_m;
    const double distance = path.norm();
    if (distance < 1e-6) return out;
    const Eigen::Vector3d direction = path / distance;
    const Rows3 emitter = point_jacobian(state, fix.emitter_offset_m);
    one_row(out, direction, emitter, fix.distance_m - distance, fix.sigma_m);
    // A distance is not linear in the place: while that is uncertain, its second-order term shifts and blurs
    // it.
    const Eigen::Matrix3d bend = (Eigen::Matrix3d::Identity() - direction * direction.transpose()) / distance;
    const Eigen::Matrix3d spread = bend * (emitter * state.covariance * emitter.transpose());
    out.residual[0] -= spread.trace() / 2;
    out.noise(0, 0) += (spread * spread).trace() / 2;
    return out;
  }

  Innovation operator()(const ContactFix& fix) const {
    Innovation out;
    const Eigen::Vector3d tip = point_of(state, fix.tip_offset_m);
    const Height surface = height_at(fix, tip);
    one_row(out, {-surface.slope_x, -surface.slope_y, 1}, point_jacobian(state, fix.tip_offset_m),
            surface.m - tip.z(), fix.sigma_m);
    return out;
  }

  // Two level directions and the vertical one.
  Innovation operator()(const AttitudeFix& fix) const {
    Innovation out;
    const Eigen::Vector3d turn = turn_of(fix.world_from_sensor * state.world_from_sensor.conjugate());
    const auto row = [&](const Eigen::Vector3d& about, double sigma) {
      out.residual[out.rows] = about.dot(turn);
      out.jacobian.block<1, 3>(out.rows, error::turn) = about.transpose();
      out.noise(out.rows, out.rows) = sigma * sigma;
      ++out.rows;
    };
    const Eigen::Vector3d side = fix.up.unitOrthogonal();
    if (fix.inclination_sigma_rad) {
      // Without regard to heading: both ups are compared, not both rotations.
      const Eigen::Vector3d up_now = state.world_from_sensor * (fix.world_from_sensor.conjugate() * fix.up);
      const Eigen::Vector3d lean = up_now.cross(fix.up);
      const Eigen::Vector3d other = fix.up.cross(side);
      for (const Eigen::Vector3d& about : {side, Eigen::Vector3d(other)}) {
        row(about, *fix.inclination_sigma_rad);
        out.residual[out.rows - 1] = about.dot(lean);
      }
    }
    if (fix.heading_sigma_rad) row(fix.up, *fix.heading_sigma_rad);
    return out;
  }
};

template <class Matrix>
bool positive(const Matrix& covariance) {
  return covariance.allFinite() && covariance.diagonal().minCoeff() > 0;
}

bool positive(double sigma) { return std::isfinite(sigma) && sigma > 0; }

struct Sound {
  bool operator()(const PointFix& fix) const {
    return fix.point_m.allFinite() && positive(fix.covariance_m2) &&
           (!fix.offset_m || fix.offset_m->allFinite());
  }
  bool operator()(const PoseFix& fix) const {
    return fix.point_m.allFinite() && fix.world_from_sensor.coeffs().allFinite() &&
           std::abs(fix.world_from_sensor.norm() - 1) < 1e-3 && positive(fix.covariance);
  }
  bool operator()(const RangeFix& fix) const {
    return fix.receiver_m.allFinite() && fix.emitter_offset_m.allFinite() && positive(fix.distance_m) &&
           positive(fix.sigma_m);
  }
  bool operator()(const ContactFix& fix) const {
    return fix.tip_offset_m.allFinite() && std::isfinite(fix.height_m) && positive(fix.sigma_m);
  }
  bool operator()(const AttitudeFix& fix) const {
    return fix.world_from_sensor.coeffs().allFinite() &&
           (!fix.inclination_sigma_rad || positive(*fix.inclination_sigma_rad)) &&
           (!fix.heading_sigma_rad || positive(*fix.heading_sigma_rad));
  }
};

}  // namespace

bool sound(const Fix& fix) { return std::visit(Sound{}, fix); }

bool places(const Fix& fix) { return !std::holds_alternative<AttitudeFix>(fix); }

Innovation innovation_of(const Fix& fix, const MotionState& state, const Eigen::Vector3d& rate_radps,
                         double assumed_lag_s) {
  return std::visit(Linearise{state, rate_radps, assumed_lag_s}, fix);
}

}  // namespace fude
