#include "calibration/imu.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace fude {
namespace {

constexpr Duration rest_length = std::chrono::milliseconds(400);
constexpr std::size_t fewest_in_rest = 8;
constexpr double still_radps = 0.03;  // standard deviation of each axis
constexpr double still_mps2 = 0.15;
constexpr double apart_cosine = 0.906;  // 25°
constexpr std::size_t fewest_directions = 6;
constexpr double worst_condition = 50;
constexpr double worst_rms_mps2 = 0.2;
constexpr double fair_rms_mps2 = 0.05;
constexpr double farthest_scale = 0.2;
constexpr std::size_t fewest_fields = 50;
constexpr double worst_field_share = 0.05;  // residual of the ellipsoid by the field

std::vector<double> listed(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

struct GravityFit {
  Eigen::Vector3d bias = Eigen::Vector3d::Zero(), scale = Eigen::Vector3d::Ones();
  double condition = 0;
  double residual(const Eigen::Vector3d& force) const {
    return scale.cwiseProduct(force - bias).norm() - standard_gravity_mps2;
  }
};

// Gauss-Newton on the length of gravity; biases count in g, so that both kinds of unknowns are of one size.
GravityFit fit_gravity(const std::vector<Eigen::Vector3d>& forces) {
  GravityFit fit;
  for (int step = 0; step < 30; ++step) {
    Eigen::MatrixXd j(Eigen::Index(forces.size()), 6);
    Eigen::VectorXd r(Eigen::Index(forces.size()));
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      const Eigen::Vector3d off = forces[std::size_t(i)] - fit.bias;
      const Eigen::Vector3d true_force = fit.scale.cwiseProduct(off);
      const Eigen::Vector3d unit = true_force.normalized();
      j.row(i) << -unit.cwiseProduct(fit.scale).transpose(),
          unit.cwiseProduct(off).transpose() / standard_gravity_mps2;
      r(i) = (true_force.norm() - standard_gravity_mps2) / standard_gravity_mps2;
    }
    const auto svd = j.jacobiSvd(Eigen::ComputeThinU | Eigen::ComputeThinV);
    fit.condition = svd.singularValues()(0) / std::max(1e-12, svd.singularValues()(5));
    const Eigen::VectorXd change = -svd.solve(r);
    fit.bias += standard_gravity_mps2 * change.head<3>();
    fit.scale += change.tail<3>();
    if (!(change.norm() > 1e-12)) break;
  }
  return fit;
}

struct Ellipsoid {
  ImuCalibration::Magnetometer magnetometer;
  double rms_share = 0;  // of the residual length by the field
};

// xᵀAx + bᵀx = 1 by least squares in centred, scaled readings: centre −A⁻¹b/2, shape the root of A.
std::optional<Ellipsoid> fit_ellipsoid(const std::vector<Eigen::Vector3d>& fields) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& f : fields) mean += f / double(fields.size());
  double size = 0;
  for (const Eigen::Vector3d& f : fields) size += (f - mean).norm() / double(fields.size());
  if (!(size > 0)) return std::nullopt;
  Eigen::MatrixXd m(Eigen::Index(fields.size()), 9);
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    const Eigen::Vector3d x = (fields[std::size_t(i)] - mean) / size;
    m.row(i) << x.x() * x.x(), x.y() * x.y(), x.z() * x.z(), 2 * x.x() * x.y(), 2 * x.x() * x.z(),
        2 * x.y() * x.z(), x.transpose();
  }
  const auto svd = m.bdcSvd(Eigen::ComputeThinU | Eigen::ComputeThinV);
  if (svd.singularValues()(8) < 1e-3 * svd.singularValues()(0)) return std::nullopt;
  const Eigen::VectorXd c = svd.solve(Eigen::VectorXd::Ones(m.rows()));
  Eigen::Matrix3d a;
  a << c(0), c(3), c(4), c(3), c(1), c(5), c(4), c(5), c(2);
  const Eigen::Vector3d centre = -0.5 * a.ldlt().solve(c.tail<3>());
  const double level = 1 + centre.dot(a * centre);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(a / level);
  if (!(solver.eigenvalues()(0) > 0)) return std::nullopt;
  const Eigen::Matrix3d root = solver.operatorSqrt();  // takes readings to the unit sphere
  Ellipsoid e;
  const double radius = 1 / std::cbrt(root.determinant());
  e.magnetometer = {mean + size * centre, radius * root};
  double sum = 0;
  for (const Eigen::Vector3d& f : fields)
    sum += std::pow((root * ((f - mean) / size - centre)).norm() - 1, 2) / double(fields.size());
  e.rms_share = std::sqrt(sum);
  return e;
}

}  // namespace

Fields to_fields(const ImuCalibration& imu) {
  Fields fields{{"gyro_bias_radps", listed(imu.gyro_bias_radps)},
                {"accel_bias_mps2", listed(imu.accel_bias_mps2)},
                {"accel_scale", listed(imu.accel_scale)}};
  if (imu.magnetometer) {
    fields.push_back({"mag_offset_ut", listed(imu.magnetometer->offset_ut)});
    const Eigen::Matrix3d& s = imu.magnetometer->shape;
    fields.push_back({"mag_shape", std::vector<double>(s.data(), s.data() + 9)});
  }
  return fields;
}

std::optional<ImuCalibration> imu_from(const Fields& fields) {
  const auto gyro = numbers_in(fields, "gyro_bias_radps"), bias = numbers_in(fields, "accel_bias_mps2"),
             scale = numbers_in(fields, "accel_scale");
  for (const auto& three : {gyro, bias, scale})
    if (!three || three->size() != 3) return std::nullopt;
  ImuCalibration imu{Eigen::Vector3d(gyro->data()), Eigen::Vector3d(bias->data()),
                     Eigen::Vector3d(scale->data()), std::nullopt};
  const auto offset = numbers_in(fields, "mag_offset_ut"), shape = numbers_in(fields, "mag_shape");
  if (offset && offset->size() == 3 && shape && shape->size() == 9)
    imu.magnetometer = {Eigen::Vector3d(offset->data()), Eigen::Matrix3d(shape->data())};
  return imu;
}

void ImuProcedure::end_window() {
  Rest rest{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  const double n = double(window_.size());
  for (const ImuSample& s : window_) {
    rest.turn_rate_radps += s.turn_rate_radps / n;
    rest.force_mps2 += s.specific_force_mps2 / n;
  }
  Eigen::Vector3d turning = Eigen::Vector3d::Zero(), shaking = turning;
  for (const ImuSample& s : window_) {
    turning += (s.turn_rate_radps - rest.turn_rate_radps).cwiseAbs2() / n;
    shaking += (s.specific_force_mps2 - rest.force_mps2).cwiseAbs2() / n;
  }
  const bool enough = window_.size() >= fewest_in_rest;
  window_.clear();
  if (!enough || turning.maxCoeff() > still_radps * still_radps ||
      shaking.maxCoeff() > still_mps2 * still_mps2)
    return;
  rests_.push_back(rest);
  const Eigen::Vector3d up = rest.force_mps2.normalized();
  const auto near = [&](const Eigen::Vector3d& d) { return d.dot(up) > apart_cosine; };
  if (std::none_of(directions_.begin(), directions_.end(), near)) directions_.push_back(up);
}

Progress ImuProcedure::add(const ImuSample& sample) {
  ++seen_;
  const bool usable = sample.valid && !sample.saturated && sample.turn_rate_radps.allFinite() &&
                      sample.specific_force_mps2.allFinite();
  if (!usable) {
    ++unusable_;
  } else {
    if (!window_.empty() && sample.time.host < window_.back().time.host) {
      ++backwards_;
      window_.clear();
    }
    window_.push_back(sample);
    if (sample.magnetic_field_ut && sample.magnetic_field_ut->allFinite())
      fields_ut_.push_back(*sample.magnetic_field_ut);
    if (sample.time.host - window_.front().time.host >= rest_length) end_window();
  }
  const std::size_t sides = std::min(directions_.size(), fewest_directions);
  return {seen_ - unusable_, double(sides) / double(fewest_directions),
          sides < fewest_directions ? "lay it on " + std::to_string(fewest_directions - sides) + " more sides"
                                    : ""};
}

Calibration<ImuCalibration> ImuProcedure::finish() const {
  CalibrationReport report;
  report.procedure = "imu";
  report.to_frame = report.from_frame = "inertial unit";
  report.unit = "m/s2";
  report.n = rests_.size();
  report.detail("directions", double(directions_.size()));
  if (unusable_ > 0)
    report.warnings.push_back(std::to_string(unusable_) + " of " + std::to_string(seen_) +
                              " samples were left out: saturated, not valid, or no numbers");
  if (backwards_ > 0)
    report.warnings.push_back("time went backwards " + std::to_string(backwards_) +
                              " times: a clock started again");
  if (rests_.empty())
    return refusal(report, "it never lay still for 0.4 s: lay it down on each of its sides");
  if (directions_.size() < fewest_directions)
    return refusal(report, "it lay on " + std::to_string(directions_.size()) + " sides, " +
                               std::to_string(fewest_directions) +
                               " are the fewest: lay it on each of its sides");

  std::vector<Eigen::Vector3d> forces, halves[2];
  for (const Rest& rest : rests_) {
    halves[forces.size() % 2].push_back(rest.force_mps2);
    forces.push_back(rest.force_mps2);
  }
  const GravityFit fit = fit_gravity(forces);
  report.condition = fit.condition;
  if (fit.condition > worst_condition)
    return refusal(report, "turn it more: the condition number " + in_words(fit.condition, 0) +
                               " says that some axis never carried its weight both ways");
  const auto lengths = [](const GravityFit& f, const std::vector<Eigen::Vector3d>& of) {
    std::vector<double> all;
    for (const Eigen::Vector3d& force : of) all.push_back(std::abs(f.residual(force)));
    return all;
  };
  summarise(report, lengths(fit, forces), 1);
  if (halves[1].size() >= fewest_directions) {
    std::vector<double> held_out = lengths(fit_gravity(halves[0]), halves[1]);
    for (const double v : lengths(fit_gravity(halves[1]), halves[0])) held_out.push_back(v);
    report.held_out_rms = root_mean_square(held_out);
  }
  const double freedom = std::max(1.0, double(forces.size()) - 6);
  report.ci95 = {0, 1.96 * report.rms * fit.condition / std::sqrt(freedom)};
  if (!(report.rms < worst_rms_mps2))
    return refusal(report, "residual " + in_words(report.rms) +
                               " m/s²: it did not lie still, or gravity is not 9.81 here");
  if ((fit.scale - Eigen::Vector3d::Ones()).cwiseAbs().maxCoeff() > farthest_scale)
    return refusal(report, "a scale is more than a fifth off: are the readings in m/s²?");

  ImuCalibration imu{.accel_bias_mps2 = fit.bias, .accel_scale = fit.scale};
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> rates;
    for (const Rest& rest : rests_) rates.push_back(rest.turn_rate_radps(axis));
    imu.gyro_bias_radps(axis) = quantile(std::move(rates), 0.5);
  }
  if (fields_ut_.size() >= fewest_fields) {
    const auto ellipsoid = fit_ellipsoid(fields_ut_);
    if (ellipsoid) report.detail("mag_residual_share", ellipsoid->rms_share);
    if (!ellipsoid)
      report.warnings.push_back("no magnetometer: the field was seen from too few sides; tumble it");
    else if (ellipsoid->rms_share > worst_field_share)
      report.warnings.push_back("no magnetometer: no ellipsoid fits the field to better than " +
                                in_words(100 * ellipsoid->rms_share, 0) +
                                " in 100; is a magnet or iron near by?");
    else
      imu.magnetometer = ellipsoid->magnetometer;
  }
  if (report.rms > fair_rms_mps2)
    report.warnings.push_back("residual " + in_words(report.rms) + " m/s²: let it lie still longer");
  report.accepted = true;
  report.reason = "gravity has its length to within " + in_words(report.p95, 3) + " m/s² on " +
                  std::to_string(directions_.size()) + " sides";
  return Calibrated<ImuCalibration>{imu, report};
}

}  // namespace fude
