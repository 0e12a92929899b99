#include "calibration/landmarks.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "calibration/pose_fields.h"

namespace fude {
namespace {

constexpr double mm_per_m = 1e3;
constexpr double worst_rms_mm = 5;
constexpr double fair_rms_mm = 1;
constexpr double finest_mm = 0.05;
constexpr double narrowest = 0.02;  // second extent by the first: less is a line
constexpr double flattest = 0.02;   // third by the first: less is a plane, whose mirror image is itself
constexpr double explains = 3;      // times smaller a residual that another reading must leave

std::vector<double> lengths_mm(const Similarity& fit, const Points3& from, const Points3& to) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < from.size(); ++i) lengths.push_back(mm_per_m * (fit(from[i]) - to[i]).norm());
  return lengths;
}

double rms_mm(const Points3& from, const Points3& to, Freedom freedom) {
  return root_mean_square(lengths_mm(register_points(from, to, freedom), from, to));
}

// Standard deviations along the principal axes, the longest first; and the axes.
struct Extent3 {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d lengths;
  Eigen::Matrix3d axes;
};
Extent3 extent(const Points3& points) {
  Extent3 e;
  for (const Eigen::Vector3d& p : points) e.centre += p / double(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points)
    scatter += (p - e.centre) * (p - e.centre).transpose() / double(points.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  e.lengths = solver.eigenvalues().reverse().cwiseMax(0).cwiseSqrt();
  e.axes = solver.eigenvectors().rowwise().reverse();
  return e;
}

template <class T>
std::vector<T> chosen(const std::vector<T>& all, const std::vector<bool>& agrees) {
  std::vector<T> some;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (agrees[i]) some.push_back(all[i]);
  return some;
}

std::vector<bool> agreeing(const Points3& from, const Points3& to) {
  const std::size_t n = from.size();
  std::vector<bool> agrees(n, true);
  if (n < 5) return agrees;
  const auto median = [](const std::vector<double>& lengths) { return quantile(lengths, 0.5); };
  std::vector<double> best = lengths_mm(register_points(from, to, Freedom::rigid), from, to);
  std::mt19937 random(1);
  for (int draw = 0; draw < 500; ++draw) {
    std::vector<bool> some(n, false);
    for (int k = 0; k < 3; ++k) some[random() % n] = true;
    const Points3 a = chosen(from, some), b = chosen(to, some);
    if (a.size() < 3 || extent(a).lengths(1) < narrowest * extent(a).lengths(0)) continue;
    const auto lengths = lengths_mm(register_points(a, b, Freedom::rigid), from, to);
    if (median(lengths) < median(best)) best = lengths;
  }
  constexpr double median_of_three = 1.538, gate = 4;
  const double few = 1 + 5 / std::max(1.0, double(n) - 3);  // Rousseeuw 1984
  for (int round = 0; round < 20; ++round) {
    const double allowed = gate * std::max(finest_mm, few * median(best) / median_of_three);
    std::vector<bool> now(n);
    for (std::size_t i = 0; i < n; ++i) now[i] = best[i] < allowed;
    const bool settled = round > 0 && now == agrees;
    agrees = now;
    if (settled) break;
    best = lengths_mm(register_points(chosen(from, agrees), chosen(to, agrees), Freedom::rigid), from, to);
  }
  return agrees;
}

// Two landmarks whose exchange explains the residual.
std::optional<std::pair<std::size_t, std::size_t>> exchanged(const Points3& from, const Points3& to,
                                                             double rms) {
  for (std::size_t i = 0; i < from.size(); ++i)
    for (std::size_t j = i + 1; j < from.size(); ++j) {
      Points3 other = from;
      std::swap(other[i], other[j]);
      if (explains * rms_mm(other, to, Freedom::rigid) < rms) return std::pair(i, j);
    }
  return std::nullopt;
}

// What a scale means to the one who made the list.
std::string unit_of(double scale) {
  const std::pair<double, const char*> known[] = {
      {25.4, "the measured points look like inches"},    {1 / 25.4, "the list looks like inches"},
      {1000, "the measured points look like metres"},    {1e-3, "the list looks like metres"},
      {10, "the measured points look like centimetres"}, {0.1, "the list looks like centimetres"}};
  for (const auto& [factor, meaning] : known)
    if (std::abs(scale / factor - 1) < 0.05) return meaning;
  return "is a length in another unit?";
}

// Error expected at a point, from the spread of the landmarks (Fitzpatrick, West, Maurer 1998).
double target_error_mm(const Extent3& e, std::size_t n, double landmark_error_mm, const Eigen::Vector3d& at) {
  const Eigen::Vector3d d = e.axes.transpose() * (at - e.centre);
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double off2 = d.squaredNorm() - d(k) * d(k);  // of the point from axis k
    const double spread2 = e.lengths.squaredNorm() - e.lengths(k) * e.lengths(k);
    sum += off2 / std::max(1e-12, spread2) / 3;
  }
  return landmark_error_mm * std::sqrt((1 + sum) / double(n));
}

}  // namespace

Similarity register_points(const Points3& from, const Points3& to, Freedom freedom) {
  const double n = double(from.size());
  Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = a;
  for (std::size_t i = 0; i < from.size(); ++i) {
    a += from[i] / n;
    b += to[i] / n;
  }
  Eigen::Matrix3d across = Eigen::Matrix3d::Zero();
  double spread = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    across += (to[i] - b) * (from[i] - a).transpose() / n;
    spread += (from[i] - a).squaredNorm() / n;
  }
  const auto svd = across.jacobiSvd(Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  const bool turned_over = svd.matrixU().determinant() * svd.matrixV().determinant() < 0;
  if (turned_over != (freedom == Freedom::mirrored)) sign(2) = -1;
  Similarity fit;
  fit.rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  if (freedom == Freedom::scaled && spread > 0) fit.scale = svd.singularValues().dot(sign) / spread;
  fit.translation = b - fit.scale * (fit.rotation * a);
  return fit;
}

Fields to_fields(const TrackerRegistration& registration) {
  Fields fields;
  put_pose(fields, "reference_from_tracker", registration);
  return fields;
}

std::optional<TrackerRegistration> registration_from(const Fields& fields) {
  return pose_in<Reference, Tracker>(fields, "reference_from_tracker");
}

Progress LandmarkProcedure::add(const Eigen::Vector3d& measured_m) {
  measured_.push_back(measured_m);
  const std::size_t count = measured_.size();
  return {count, std::min(1.0, double(count) / double(std::max<std::size_t>(1, landmarks_.size()))),
          count < landmarks_.size() ? "touch " + landmarks_[count].name : ""};
}

Calibration<TrackerRegistration> LandmarkProcedure::finish() const {
  CalibrationReport report;
  report.procedure = "tracker";
  report.to_frame = "reference";
  report.from_frame = "tracker";
  report.n = measured_.size();
  if (measured_.size() != landmarks_.size())
    return refusal(report, std::to_string(measured_.size()) + " points were measured, but " +
                               std::to_string(landmarks_.size()) + " landmarks are listed");
  if (landmarks_.size() < 3)
    return refusal(report, "only " + std::to_string(landmarks_.size()) + " landmarks, 3 are the fewest");
  Points3 listed;
  for (const Landmark& landmark : landmarks_) listed.push_back(landmark.at_m);
  const auto finite = [](const Eigen::Vector3d& p) { return p.allFinite(); };
  if (!std::all_of(listed.begin(), listed.end(), finite) ||
      !std::all_of(measured_.begin(), measured_.end(), finite))
    return refusal(report, "a coordinate is no number");
  for (const Points3* points : {static_cast<const Points3*>(&listed), &measured_})
    if (const Extent3 e = extent(*points); e.lengths(1) <= narrowest * e.lengths(0))
      return refusal(report, std::string(points == &listed ? "the landmarks" : "the measured points") +
                                 " lie on one line, or in one place: use landmarks that span a triangle");

  const std::vector<bool> agrees = agreeing(measured_, listed);
  const Points3 from = chosen(measured_, agrees), to = chosen(listed, agrees);
  const Similarity fit = register_points(from, to, Freedom::rigid);
  const Similarity scaled = register_points(measured_, listed, Freedom::scaled);
  summarise(report, lengths_mm(fit, from, to), 3);
  const Extent3 e = extent(from);
  report.condition = e.lengths(0) / e.lengths(1);
  const std::vector<double> each = lengths_mm(fit, measured_, listed);
  std::vector<std::string> names, outliers;
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    names.push_back(landmarks_[i].name);
    if (!agrees[i]) outliers.push_back(landmarks_[i].name + ", " + in_words(each[i]) + " mm off");
  }
  const double scaled_rms = root_mean_square(lengths_mm(scaled, measured_, listed));
  const double plain_rms = rms_mm(measured_, listed, Freedom::rigid);
  report.detail("landmarks", names);
  report.detail("residuals_mm", each);
  report.detail("outliers", outliers);
  report.detail("plain_rms_mm", plain_rms);
  report.detail("scale", scaled.scale);
  report.detail("scaled_rms_mm", scaled_rms);

  if (plain_rms > fair_rms_mm) {
    if (std::abs(scaled.scale - 1) > 0.3 && explains * scaled_rms < plain_rms)
      return refusal(report,
                     "a scale of " + in_words(scaled.scale, 3) + " would fit: " + unit_of(scaled.scale));
    if (extent(listed).lengths(2) > flattest * extent(listed).lengths(0) &&
        explains * rms_mm(measured_, listed, Freedom::mirrored) < plain_rms)
      return refusal(report,
                     "the measured points are the mirror image of the list: an axis has the wrong sign");
    if (const auto pair = exchanged(measured_, listed, plain_rms))
      return refusal(report, "were " + names[pair->first] + " and " + names[pair->second] +
                                 " touched in the other order? Exchanged, they fit");
  }
  if (4 * outliers.size() > landmarks_.size())
    return refusal(report,
                   std::to_string(outliers.size()) + " of " + std::to_string(landmarks_.size()) +
                       " landmarks do not fit the others: were they touched in the order of the list?");
  if (report.rms > worst_rms_mm)
    return refusal(report,
                   "residual " + in_words(report.rms, 1) +
                       " mm: were the landmarks touched in the order of the list, and did nothing move?");

  if (from.size() > 3) {
    std::vector<double> left_out;
    for (std::size_t i = 0; i < from.size(); ++i) {
      std::vector<bool> others(from.size(), true);
      others[i] = false;
      const Similarity without = register_points(chosen(from, others), chosen(to, others), Freedom::rigid);
      left_out.push_back(mm_per_m * (without(from[i]) - to[i]).norm());
    }
    report.held_out_rms = root_mean_square(left_out);
  }
  const double n = double(from.size());
  const double landmark_error = report.rms * std::sqrt(n / (n - 2));
  double worst = 0;
  for (const Eigen::Vector3d& p : from)
    worst = std::max(worst, target_error_mm(e, from.size(), landmark_error, p));
  // Of three coordinates whose scatter is itself known from few: √(3·F(3, freedom)) at 95 %, to 3 % from six
  // on.
  const double radius = 2.795 * (1 + 1.9 / (3 * n - 6));
  report.ci95 = {0, radius * worst / std::numbers::sqrt3};
  if (!outliers.empty())
    report.warnings.push_back(std::to_string(outliers.size()) +
                              " landmarks do not fit and were left out: " + outliers[0]);
  if (std::abs(scaled.scale - 1) > 0.005 && 1.5 * scaled_rms < plain_rms)
    report.warnings.push_back("a scale of " + in_words(scaled.scale, 4) + " would fit better, " +
                              in_words(scaled_rms) + " mm instead of " + in_words(plain_rms) +
                              " mm: is a length off?");
  if (report.rms > fair_rms_mm)
    report.warnings.push_back("residual " + in_words(report.rms) + " mm: touch the landmarks more carefully");
  report.accepted = true;
  report.reason = "points at the landmarks are known to within " + in_words((*report.ci95)[1]) + " mm (95 %)";
  return Calibrated<TrackerRegistration>{{Eigen::Quaterniond(fit.rotation).normalized(), fit.translation},
                                         report};
}

}  // namespace fude
