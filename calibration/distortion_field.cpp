#include "calibration/distortion_field.h"

#include <limits>
#include <string>

#include "calibration/fusion/motion_state.h"

namespace fude {
namespace {

using Row = Eigen::RowVector3d;

std::vector<double> listed(const Eigen::MatrixXd& m) {
  std::vector<double> list;
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    for (Eigen::Index j = 0; j < m.cols(); ++j) list.push_back(m(i, j));
  return list;
}

std::optional<Eigen::MatrixXd> rows_of_three(const Fields& fields, const std::string& key) {
  const auto list = numbers_in(fields, key);
  if (!list || list->empty() || list->size() % 3 != 0) return std::nullopt;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  Eigen::MatrixXd m = Eigen::Map<const Rows>(list->data(), Eigen::Index(list->size() / 3), 3);
  return m.allFinite() ? std::optional(std::move(m)) : std::nullopt;
}

void put(Fields& fields, const std::string& key, const SmoothField& field) {
  fields.push_back({key + "_free_shape", double(field.shape())});
  fields.push_back({key + "_weights", listed(field.weights())});
  fields.push_back({key + "_coefficients", listed(field.coefficients())});
}

struct Places {
  Row centre_m;
  double scale_m = 1;
  Eigen::MatrixXd knots;
};

std::optional<SmoothField> field_in(const Fields& fields, const std::string& key, const Places& places) {
  const auto shape = numbers_in(fields, key + "_free_shape");
  const auto weights = rows_of_three(fields, key + "_weights");
  const auto coefficients = rows_of_three(fields, key + "_coefficients");
  if (!shape || shape->size() != 1 || !weights || !coefficients) return std::nullopt;
  for (const FreeShape free : {FreeShape::plane, FreeShape::quadric})
    if (shape->front() == double(free) && weights->rows() == places.knots.rows() &&
        coefficients->rows() == Eigen::Index(terms(free, 3)))
      return SmoothField(free, places.centre_m, places.scale_m, places.knots, *weights, *coefficients);
  return std::nullopt;
}

}  // namespace

CorrectedPose corrected(const DistortionField& field, const Pose<Tracker, Tool>& measured) {
  const SmoothField& shift = field.shift_m;
  Row place = measured.translation.transpose();
  double least2 = std::numeric_limits<double>::infinity();
  Row nearest = place;
  for (Eigen::Index i = 0; i < shift.knots().rows(); ++i) {
    const Row mapped = shift.scale() * shift.knots().row(i) + shift.centre();
    if (const double d2 = (mapped - place).squaredNorm(); d2 < least2) {
      least2 = d2;
      nearest = mapped;
    }
  }
  CorrectedPose pose{measured, least2 <= field.reach_m * field.reach_m};
  if (!pose.mapped) place = nearest + field.reach_m / std::sqrt(least2) * (place - nearest);
  pose.tracker_from_tool.translation += shift.at(place).transpose();
  if (field.turn_rad)
    pose.tracker_from_tool.rotation =
        (rotation_of(field.turn_rad->at(place).transpose()) * measured.rotation).normalized();
  return pose;
}

Fields to_fields(const DistortionField& field) {
  const SmoothField& shift = field.shift_m;
  Fields fields{{"distortion_reach_m", field.reach_m},
                {"distortion_centre_m", std::vector<double>(shift.centre().begin(), shift.centre().end())},
                {"distortion_scale_m", shift.scale()},
                {"distortion_knots", listed(shift.knots())}};
  put(fields, "distortion_shift_m", shift);
  if (field.turn_rad) put(fields, "distortion_turn_rad", *field.turn_rad);
  return fields;
}

std::optional<DistortionField> distortion_from(const Fields& fields) {
  const auto reach = numbers_in(fields, "distortion_reach_m");
  const auto centre = rows_of_three(fields, "distortion_centre_m");
  const auto scale = numbers_in(fields, "distortion_scale_m");
  const auto knots = rows_of_three(fields, "distortion_knots");
  if (!reach || reach->size() != 1 || !(reach->front() > 0) || !centre || centre->rows() != 1 || !scale ||
      scale->size() != 1 || !(scale->front() > 0) || !knots)
    return std::nullopt;
  const Places places{centre->row(0), scale->front(), *knots};
  const auto shift = field_in(fields, "distortion_shift_m", places);
  if (!shift) return std::nullopt;
  DistortionField field{*shift, std::nullopt, reach->front()};
  if (numbers_in(fields, "distortion_turn_rad_free_shape")) {
    field.turn_rad = field_in(fields, "distortion_turn_rad", places);
    if (!field.turn_rad) return std::nullopt;
  }
  return field;
}

}  // namespace fude
