#include "calibration/fusion/motion_filter.h"

#include <cmath>
#include <numbers>

namespace fude {
namespace {

constexpr double free_heading_rad = std::numbers::pi;
constexpr int outliers_to_regain = 3;
constexpr double unknown_turn_rad2 = 1;  // of a variance: no linear filter finds back from there

// Chi-square with n degrees of freedom at the probability of a normal deviate within ±z: Wilson and Hilferty.
double chi_square(int n, double z) {
  if (n == 1) return z * z;
  // The one-sided deviate of the same probability; accurate to 1 % between 2 and 6 sigma.
  const double one_sided = z - 0.6931 / (z + 1 / z);
  const double k = 2.0 / (9.0 * n);
  return n * std::pow(1 - k + one_sided * std::sqrt(k), 3);
}

}  // namespace

MotionFilter::MotionFilter(const FusionSettings& settings)
    : settings_(settings), orientation_(settings.orientation) {
  motion_.lever_m = settings.lever_m;
  motion_.lag_s = settings.lag_s;
  ErrorMatrix& p = motion_.covariance;
  const auto prior = [&p](int at, int n, double sigma) {
    p.diagonal().segment(at, n).setConstant(sigma * sigma);
  };
  prior(error::position, 3, settings.start_position_sigma_m);
  prior(error::velocity, 3, settings.start_velocity_mps);
  prior(error::turn, 3, free_heading_rad);
  prior(error::gyro, 3, settings.orientation.start_bias_radps);
  prior(error::accel, 3, settings.start_accel_mps2);
  prior(error::lever, 3, settings.lever_sigma_m);
  prior(error::lag, 1, settings.lag_sigma_s);
  prior(error::gyro_lag, 1, settings.gyro_lag_sigma_s);
  motion_.position_m = settings.start_position_m;
}

void MotionFilter::start(Timestamp time) {
  started_ = true;
  time_ = fix_time_ = time;
}

void MotionFilter::begin_again() {
  const FusionCounts counts = counts_;
  *this = MotionFilter(FusionSettings(settings_));
  counts_ = counts;
}

void MotionFilter::step(Timestamp time, const InertialInput& input, ErrorMatrix* transition) {
  const double step_s = seconds(time - time_);
  if (!(step_s > 0)) return;
  if (has_input_ && seconds(time - input_time_) <= settings_.coast_s)
    advance(motion_, input, step_s, settings_.noise, transition);
  else
    coast(motion_, step_s, settings_.noise, transition);
  time_ = time;
  if (!placed_) {
    // Without a place there is nothing to move; what is believed of it stays the first guess.
    motion_.position_m = settings_.start_position_m;
    motion_.velocity_mps.setZero();
    forget(error::position, settings_.start_position_sigma_m);
    forget(error::velocity, settings_.start_velocity_mps);
  }
}

void MotionFilter::move_to(Timestamp time, ErrorMatrix* transition) {
  if (started_) step(time, input_, transition);
}

bool MotionFilter::take(const InertialReading& reading, Timestamp time, ErrorMatrix* transition) {
  if (!plausible(reading)) {
    ++counts_.unsound;
    return false;
  }
  if (has_input_ && time <= input_time_) {
    ++counts_.repeated;
    return false;
  }
  if (!started_) start(time);
  const double since = has_input_ ? seconds(time - input_time_) : settings_.orientation.longest_step_s / 100;
  InertialInput now{reading.turn_rate_radps, reading.specific_force_mps2};
  if (has_input_) now.rate_change_radps = now.turn_rate_radps - input_.turn_rate_radps;
  if (has_input_ && since > settings_.coast_s) ++counts_.coasted;
  step(time, now, transition);  // a reading is the mean since the one before
  if (since > settings_.orientation.longest_step_s &&
      motion_.covariance.diagonal().segment<3>(error::turn).maxCoeff() > unknown_turn_rad2)
    levelled_ = false;
  InertialReading seen = reading;
  if (!settings_.use_field) seen.magnetic_field_ut.reset();
  orientation_.add(seen, since);
  if (!levelled_ && settings_.use_gravity && now.specific_force_mps2.norm() > 1) {
    levelled_ = true;
    motion_.world_from_sensor = settings_.world_from_earth * orientation_.earth_from_sensor();
    forget(error::turn, settings_.start_inclination_rad);
    const Eigen::Vector3d up = settings_.world_from_earth * Eigen::Vector3d::UnitZ();
    const double heading = orientation_.has_heading() ? settings_.start_heading_rad : free_heading_rad;
    motion_.covariance.block<3, 3>(error::turn, error::turn) += up * up.transpose() * heading * heading;
    attitude_time_ = time;
  }
  input_ = now;
  input_.rate_change_radps.setZero();  // has been taken
  input_time_ = time;
  has_input_ = true;
  ++counts_.inertial;
  return true;
}

std::optional<AttitudeFix> MotionFilter::attitude_due() {
  if (!levelled_ || input_time_ != time_ || seconds(input_time_ - attitude_time_) < settings_.attitude_s)
    return std::nullopt;
  attitude_time_ = input_time_;
  AttitudeFix fix;
  // That filter is of the gyroscope's time.
  fix.world_from_sensor = settings_.world_from_earth * orientation_.earth_from_sensor() *
                          rotation_of(motion_.gyro_lag_s * rate_radps());
  fix.up = settings_.world_from_earth * Eigen::Vector3d::UnitZ();
  if (settings_.use_gravity) fix.inclination_sigma_rad = settings_.gravity_sigma_rad;
  if (settings_.use_field && orientation_.has_heading()) {
    if (orientation_.field_disturbed())
      ++counts_.disturbed_field;
    else
      fix.heading_sigma_rad = settings_.field_sigma_rad;
  }
  if (!fix.inclination_sigma_rad && !fix.heading_sigma_rad) return std::nullopt;
  return fix;
}

void MotionFilter::forget(int at, double sigma) {
  motion_.covariance.middleRows<3>(at).setZero();
  motion_.covariance.middleCols<3>(at).setZero();
  motion_.covariance.diagonal().segment<3>(at).setConstant(sigma * sigma);
}

void MotionFilter::anchor(const Fix& fix) {
  placed_ = true;
  if (const auto* pose = std::get_if<PoseFix>(&fix)) {
    motion_.world_from_sensor = pose->world_from_sensor;
    forget(error::turn, 0);
    motion_.covariance.block<3, 3>(error::turn, error::turn) = pose->covariance.bottomRightCorner<3, 3>();
    motion_.position_m = pose->point_m - motion_.world_from_sensor * motion_.lever_m;
  } else if (const auto* point = std::get_if<PointFix>(&fix)) {
    motion_.position_m =
        point->point_m -
        motion_.world_from_sensor * (motion_.lever_m + point->offset_m.value_or(Eigen::Vector3d::Zero()));
  }
  forget(error::position, settings_.start_position_sigma_m);
  forget(error::velocity, settings_.start_velocity_mps);
}

FixResult MotionFilter::take(const Fix& fix, Timestamp time, double assumed_lag_s) {
  if (!sound(fix)) {
    ++counts_.unsound;
    return {FixOutcome::unsound};
  }
  if (!started_) start(time);
  step(time, input_, nullptr);
  if (!places(fix)) return correct(innovation_of(fix, motion_, rate_radps(), 0), true);

  bool anchored = false;
  if (!placed_ || state() == FusionState::lost) {
    motion_.velocity_mps.setZero();
    anchor(fix);
    anchored = true;
  }
  FixResult result = correct(innovation_of(fix, motion_, rate_radps(), assumed_lag_s), anchored);
  if (result.outcome == FixOutcome::outlier) {
    ++outliers_;
    if (!first_outlier_) first_outlier_ = time;
    const bool persistent = outliers_ >= outliers_to_regain &&
                            seconds(time - *first_outlier_) >= settings_.regain_s &&
                            seconds(time - fix_time_) >= settings_.regain_s;
    if (!persistent) {
      ++counts_.outliers;
      return result;
    }
    ++counts_.changed_mind;
    anchor(fix);  // the place is another one, the hand goes on as it went
    anchored = true;
    result = correct(innovation_of(fix, motion_, rate_radps(), assumed_lag_s), true);
  }
  if (anchored) result.outcome = FixOutcome::anchored;
  ++(anchored ? counts_.anchored : counts_.used);
  first_outlier_.reset();
  outliers_ = 0;
  fix_time_ = time;
  return result;
}

template <int Rows>
FixResult MotionFilter::correct_rows(const Innovation& innovation, bool soft) {
  const Eigen::Matrix<double, Rows, error::size> h = innovation.jacobian.topRows<Rows>();
  const Eigen::Matrix<double, Rows, 1> residual = innovation.residual.head<Rows>();
  Eigen::Matrix<double, Rows, Rows> noise = innovation.noise.topLeftCorner<Rows, Rows>();
  const Eigen::Matrix<double, error::size, Rows> crossed = motion_.covariance * h.transpose();
  const Eigen::Matrix<double, Rows, Rows> spread = h * crossed;
  Eigen::LLT<Eigen::Matrix<double, Rows, Rows>> factor(spread + noise);
  FixResult result{FixOutcome::used, residual.dot(factor.solve(residual)), Rows};
  const double gate = chi_square(Rows, settings_.gate_quantile_sigma);
  if (!(result.squared_innovation <= gate)) {
    if (!soft) {
      result.outcome = FixOutcome::outlier;
      return result;
    }
    noise *= std::max(1.0, result.squared_innovation / gate);
    factor.compute(spread + noise);
  }
  const Eigen::Matrix<double, error::size, Rows> gain = factor.solve(crossed.transpose()).transpose();
  motion_.add(gain * residual);
  motion_.covariance.noalias() -= gain * crossed.transpose();
  motion_.covariance = (0.5 * (motion_.covariance + motion_.covariance.transpose())).eval();
  return result;
}

FixResult MotionFilter::correct(const Innovation& innovation, bool soft) {
  switch (innovation.rows) {
    case 1:
      return correct_rows<1>(innovation, soft);
    case 2:
      return correct_rows<2>(innovation, soft);
    case 3:
      return correct_rows<3>(innovation, soft);
    case 6:
      return correct_rows<6>(innovation, soft);
    default:
      return {FixOutcome::unsound};
  }
}

FusionState MotionFilter::state() const {
  if (!placed_ || !motion_.position_m.allFinite()) return FusionState::lost;
  const double silence = seconds(time_ - fix_time_);
  const double variance = motion_.covariance.diagonal().segment<3>(error::position).maxCoeff();
  if (silence > settings_.lost_s) return FusionState::lost;
  if (silence > settings_.predicted_s)
    return variance > settings_.lost_sigma_m * settings_.lost_sigma_m ? FusionState::lost
                                                                      : FusionState::predicted;
  return FusionState::ok;
}

}  // namespace fude
