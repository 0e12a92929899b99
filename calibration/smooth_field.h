// A smooth function through scattered, noisy values in two or three dimensions, as smooth as cross-validation
// finds it: a polyharmonic smoothing spline (Duchon 1977; Wahba, Spline Models for Observational Data, 1990).
#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace fude {

// What the spline does not hold against the data: polynomials up to this degree cost nothing.
enum class FreeShape : int {
  plane = 1,    // thin plate: bending is penalised
  quadric = 2,  // the change of bending is penalised: a bowl costs nothing
  bowed = 3,  // nor do cubes and fourth powers of each coordinate: a sheet that bends one way, as paper does
};

class SmoothField {
 public:
  // `points` n × 2 or n × 3, `values` n × k, a function each. At least as many points as the polynomial has
  // terms, not all on one of its zero sets; about 250 at the most (n³). The smoothing is that of the least
  // generalised cross-validation over all k, degrees of freedom counted 1.4 times (Gu 2002), which guards
  // against taking noise for shape.
  static SmoothField fit(const Eigen::MatrixXd& points, const Eigen::MatrixXd& values, FreeShape shape);

  // The polynomial alone, by least squares.
  static SmoothField polynomial(const Eigen::MatrixXd& points, const Eigen::MatrixXd& values,
                                FreeShape shape);

  // One that was stored: the parts below.
  SmoothField(FreeShape shape, Eigen::RowVectorXd centre, double scale, Eigen::MatrixXd knots,
              Eigen::MatrixXd weights, Eigen::MatrixXd coefficients);

  // Both with + − × ÷, square roots and fude's own logarithm alone: the same bits on every machine.
  Eigen::RowVectorXd at(const Eigen::RowVectorXd& point) const;
  // A row for each coordinate of the point, a column for each function.
  Eigen::MatrixXd slope(const Eigen::RowVectorXd& point) const;

  FreeShape shape() const { return shape_; }
  const Eigen::RowVectorXd& centre() const { return centre_; }  // points are (x − centre)/scale inside
  double scale() const { return scale_; }
  const Eigen::MatrixXd& knots() const { return knots_; }
  const Eigen::MatrixXd& weights() const { return weights_; }
  const Eigen::MatrixXd& coefficients() const { return coefficients_; }

  // Of the fit: n × k residuals of each point by the function that was fitted without it; degrees of freedom.
  const Eigen::MatrixXd& left_out_residuals() const { return left_out_; }
  double freedom() const { return freedom_; }

 private:
  SmoothField() = default;
  static SmoothField begin(const Eigen::MatrixXd& points, FreeShape shape);

  FreeShape shape_ = FreeShape::plane;
  Eigen::RowVectorXd centre_;
  double scale_ = 1;
  Eigen::MatrixXd knots_, weights_, coefficients_, left_out_;
  double freedom_ = 0;
};

// Terms of the polynomial in that many dimensions.
std::size_t terms(FreeShape shape, int dimensions);

}  // namespace fude
