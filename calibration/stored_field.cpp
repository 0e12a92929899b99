#include "calibration/stored_field.h"

#include <algorithm>
#include <cmath>

namespace fude {
namespace {

std::vector<double> listed(const Eigen::MatrixXd& m) {
  std::vector<double> list;
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    for (Eigen::Index j = 0; j < m.cols(); ++j) list.push_back(m(i, j));
  return list;
}

Eigen::MatrixXd matrix(const std::vector<double>& list, Eigen::Index columns) {
  Eigen::MatrixXd m(Eigen::Index(list.size()) / columns, columns);
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    for (Eigen::Index j = 0; j < columns; ++j) m(i, j) = list[std::size_t(i * columns + j)];
  return m;
}

}  // namespace

void store(Fields& fields, const std::string& name, const SmoothField& field) {
  fields.push_back({name + "_centre_mm", listed(field.centre())});
  fields.push_back({name + "_scale_mm", field.scale()});
  fields.push_back({name + "_knots", listed(field.knots())});
  fields.push_back({name + "_weights_mm", listed(field.weights())});
  fields.push_back({name + "_polynomial_mm", listed(field.coefficients())});
}

std::optional<SmoothField> stored_field(const Fields& fields, const std::string& name, int functions) {
  const auto centre = numbers_in(fields, name + "_centre_mm"), scale = numbers_in(fields, name + "_scale_mm"),
             knots = numbers_in(fields, name + "_knots"), weights = numbers_in(fields, name + "_weights_mm"),
             polynomial = numbers_in(fields, name + "_polynomial_mm");
  if (!centre || !scale || !knots || !weights || !polynomial) return std::nullopt;
  for (const auto* numbers : {&*centre, &*scale, &*knots, &*weights, &*polynomial})
    if (!std::ranges::all_of(*numbers, [](double v) { return std::isfinite(v); })) return std::nullopt;
  const auto k = std::size_t(functions);
  if (centre->size() != 2 || scale->size() != 1 || !(scale->front() > 0) || knots->size() % 2 != 0 ||
      knots->size() / 2 * k != weights->size())
    return std::nullopt;
  for (const FreeShape shape : {FreeShape::plane, FreeShape::quadric, FreeShape::bowed})
    if (polynomial->size() == k * terms(shape, 2))
      return SmoothField(shape, Eigen::RowVector2d((*centre)[0], (*centre)[1]), scale->front(),
                         matrix(*knots, 2), matrix(*weights, functions), matrix(*polynomial, functions));
  return std::nullopt;
}

}  // namespace fude
