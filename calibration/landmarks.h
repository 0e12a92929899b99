// Where a tracker stands to a reference: points known in the reference's frame, measured in the tracker's.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/report.h"
#include "signal/pose.h"
#include "signal/pose_sample.h"

namespace fude {

// The frame in which landmarks are listed, as whoever made the list draws it; metres.
struct Reference {};

struct Landmark {
  std::string name;
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();
};

using Points3 = std::vector<Eigen::Vector3d>;

// scale · rotation · from + translation, nearest to `to` by least squares (Umeyama 1991).
struct Similarity {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  // a mirror too, where that was allowed
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  double scale = 1;
  Eigen::Vector3d operator()(const Eigen::Vector3d& p) const { return scale * (rotation * p) + translation; }
};
enum class Freedom { rigid, scaled, mirrored };
// As many points in `from` as in `to`, three at least.
Similarity register_points(const Points3& from, const Points3& to, Freedom freedom);

using TrackerRegistration = Pose<Reference, Tracker>;  // metres
Fields to_fields(const TrackerRegistration& registration);
std::optional<TrackerRegistration> registration_from(const Fields& fields);

class LandmarkProcedure {
 public:
  explicit LandmarkProcedure(std::vector<Landmark> landmarks) : landmarks_(std::move(landmarks)) {}

  // The next landmark of the list as the tracker has it, metres.
  Progress add(const Eigen::Vector3d& measured_m);

  // Rigid: no scale. With five landmarks or more, those four standard deviations off a fit that half of them
  // agree with are named and left out. Refused: another number of points than landmarks; fewer than three,
  // or all on a line; a mirror, a scale or two landmarks exchanged that explain what a rigid motion does not;
  // a residual above 5 mm; more than a quarter left out. Details: each landmark's residual.
  Calibration<TrackerRegistration> finish() const;

 private:
  std::vector<Landmark> landmarks_;
  Points3 measured_;
};

}  // namespace fude
