#include "calibration/smooth_field.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <utility>

#include "signal/elementary.h"

namespace fude {
namespace {

// Green's function of the penalty, with the sign that makes it positive on what the polynomials leave. A
// calibrated tablet paints through it: the same bits on every machine.
double kernel(double r2, FreeShape shape, Eigen::Index dimensions) {
  if (!(r2 > 0)) return 0;
  const bool thin = shape == FreeShape::plane;
  if (dimensions == 2) {
    const double log_r2 = elementary::logarithm(r2);
    return thin ? 0.5 * r2 * log_r2 : -0.5 * r2 * r2 * log_r2;
  }
  const double r = elementary::square_root(r2);
  return thin ? -r : r2 * r;
}

// Its derivative by r2; that of the flat kernel in three dimensions has none at 0.
double kernel_slope(double r2, FreeShape shape, Eigen::Index dimensions) {
  if (!(r2 > 0)) return 0;
  const bool thin = shape == FreeShape::plane;
  if (dimensions == 2) {
    const double log_r2 = elementary::logarithm(r2);
    return thin ? 0.5 * (log_r2 + 1) : -r2 * (log_r2 + 0.5);
  }
  const double r = elementary::square_root(r2);
  return thin ? -0.5 / r : 1.5 * r;
}

Eigen::RowVectorXd monomials(const Eigen::RowVectorXd& x, FreeShape shape) {
  Eigen::RowVectorXd row(Eigen::Index(terms(shape, int(x.size()))));
  Eigen::Index at = 0;
  row(at++) = 1;
  for (Eigen::Index i = 0; i < x.size(); ++i) row(at++) = x(i);
  if (shape != FreeShape::plane)
    for (Eigen::Index i = 0; i < x.size(); ++i)
      for (Eigen::Index j = i; j < x.size(); ++j) row(at++) = x(i) * x(j);
  if (shape == FreeShape::bowed)
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double cube = x(i) * x(i) * x(i);
      row(at++) = cube;
      row(at++) = cube * x(i);
    }
  return row;
}

// A row for each coordinate that they are differentiated by.
Eigen::MatrixXd monomial_slopes(const Eigen::RowVectorXd& x, FreeShape shape) {
  const Eigen::Index d = x.size();
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(d, Eigen::Index(terms(shape, int(d))));
  Eigen::Index at = 1;
  for (Eigen::Index i = 0; i < d; ++i) slopes(i, at++) = 1;
  if (shape != FreeShape::plane)
    for (Eigen::Index i = 0; i < d; ++i)
      for (Eigen::Index j = i; j < d; ++j, ++at) {
        slopes(i, at) += x(j);
        slopes(j, at) += x(i);
      }
  if (shape == FreeShape::bowed)
    for (Eigen::Index i = 0; i < d; ++i) {
      slopes(i, at++) = 3 * x(i) * x(i);
      slopes(i, at++) = 4 * x(i) * x(i) * x(i);
    }
  return slopes;
}

Eigen::MatrixXd monomials_of_all(const Eigen::MatrixXd& knots, FreeShape shape) {
  Eigen::MatrixXd t(knots.rows(), Eigen::Index(terms(shape, int(knots.cols()))));
  for (Eigen::Index i = 0; i < knots.rows(); ++i) t.row(i) = monomials(knots.row(i), shape);
  return t;
}

}  // namespace

std::size_t terms(FreeShape shape, int dimensions) {
  const auto d = static_cast<std::size_t>(dimensions);
  if (shape == FreeShape::plane) return d + 1;
  return (d + 1) * (d + 2) / 2 + (shape == FreeShape::bowed ? 2 * d : 0);
}

SmoothField::SmoothField(FreeShape shape, Eigen::RowVectorXd centre, double scale, Eigen::MatrixXd knots,
                         Eigen::MatrixXd weights, Eigen::MatrixXd coefficients)
    : shape_(shape),
      centre_(std::move(centre)),
      scale_(scale),
      knots_(std::move(knots)),
      weights_(std::move(weights)),
      coefficients_(std::move(coefficients)) {}

SmoothField SmoothField::begin(const Eigen::MatrixXd& points, FreeShape shape) {
  SmoothField field;
  field.shape_ = shape;
  field.centre_ = points.colwise().mean();
  field.knots_ = points.rowwise() - field.centre_;
  field.scale_ = std::max(field.knots_.cwiseAbs().maxCoeff(), 1e-300);
  field.knots_ /= field.scale_;
  return field;
}

SmoothField SmoothField::polynomial(const Eigen::MatrixXd& points, const Eigen::MatrixXd& values,
                                    FreeShape shape) {
  SmoothField field = begin(points, shape);
  const Eigen::MatrixXd t = monomials_of_all(field.knots_, shape);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(t);
  field.coefficients_ = qr.solve(values);
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(t.rows(), t.cols());
  field.left_out_ = values - t * field.coefficients_;
  for (Eigen::Index i = 0; i < t.rows(); ++i)
    field.left_out_.row(i) /= std::max(1e-9, 1 - q.row(i).squaredNorm());
  field.freedom_ = double(t.cols());
  field.weights_ = Eigen::MatrixXd::Zero(0, values.cols());
  field.knots_.resize(0, points.cols());
  return field;
}

// With f = K·c + T·d, Tᵀc = 0 and residual λ·c (Wahba 1990, 1.3): in a basis Q of what T leaves, QᵀKQ = UΛUᵀ,
// and with W = QU the residual is W·diag(λ/(Λ + λ))·Wᵀ·values, whose diagonal gives every point left out.
SmoothField SmoothField::fit(const Eigen::MatrixXd& points, const Eigen::MatrixXd& values, FreeShape shape) {
  SmoothField field = begin(points, shape);
  const Eigen::Index n = points.rows();
  const Eigen::MatrixXd t = monomials_of_all(field.knots_, shape);
  const Eigen::Index rest = n - t.cols();
  if (rest < 1) return polynomial(points, values, shape);

  Eigen::MatrixXd k(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      k(i, j) = k(j, i) =
          kernel((field.knots_.row(i) - field.knots_.row(j)).squaredNorm(), shape, points.cols());
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(t);
  const Eigen::MatrixXd all = qr.householderQ() * Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd q = all.rightCols(rest);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(q.transpose() * k * q);
  const Eigen::ArrayXd stiffness = solver.eigenvalues().array().max(0);
  const Eigen::MatrixXd w = q * solver.eigenvectors();
  const Eigen::MatrixXd z = w.transpose() * values;
  const Eigen::ArrayXd power = z.rowwise().squaredNorm().array();

  constexpr double freedom_counts = 1.4;
  double best = std::numeric_limits<double>::infinity(), lambda = 0;
  const double largest = std::max(stiffness.maxCoeff(), 1e-300);
  for (double exponent = -12; exponent <= 4; exponent += 0.25) {
    const double trial = largest * std::pow(10.0, exponent);
    const Eigen::ArrayXd kept = trial / (stiffness + trial);
    const double left = double(n) - freedom_counts * (double(n) - kept.sum());
    if (left <= 0) continue;
    if (const double score = (kept.square() * power).sum() / (left * left); score < best) {
      best = score;
      lambda = trial;
    }
  }
  const Eigen::ArrayXd kept = lambda / (stiffness + lambda);
  const Eigen::MatrixXd residual = w * kept.matrix().asDiagonal() * z;
  field.weights_ = w * (stiffness + lambda).inverse().matrix().asDiagonal() * z;
  field.coefficients_ = qr.solve(values - residual - k * field.weights_);
  field.freedom_ = double(n) - kept.sum();
  field.left_out_ = residual;
  const Eigen::VectorXd share = w.array().square().matrix() * kept.matrix();
  for (Eigen::Index i = 0; i < n; ++i) field.left_out_.row(i) /= std::max(1e-9, share(i));
  return field;
}

Eigen::RowVectorXd SmoothField::at(const Eigen::RowVectorXd& point) const {
  const Eigen::RowVectorXd x = (point - centre_) / scale_;
  Eigen::RowVectorXd value = monomials(x, shape_) * coefficients_;
  for (Eigen::Index i = 0; i < knots_.rows(); ++i)
    value += kernel((x - knots_.row(i)).squaredNorm(), shape_, x.size()) * weights_.row(i);
  return value;
}

Eigen::MatrixXd SmoothField::slope(const Eigen::RowVectorXd& point) const {
  const Eigen::RowVectorXd x = (point - centre_) / scale_;
  Eigen::MatrixXd slopes = monomial_slopes(x, shape_) * coefficients_;
  for (Eigen::Index i = 0; i < knots_.rows(); ++i) {
    const Eigen::RowVectorXd from = x - knots_.row(i);
    slopes += (2 * kernel_slope(from.squaredNorm(), shape_, x.size())) * from.transpose() * weights_.row(i);
  }
  return slopes / scale_;
}

}  // namespace fude
