#include "sim/brush/skeleton.h"

#include "signal/elementary.h"

namespace fude {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

auto index(int i) { return static_cast<std::size_t>(i); }

// sin(t)/t, (1 − cos t)/t² and (t − sin t)/t³.
struct RotationSeries {
  double sine;
  double versine;
  double remainder;
};

RotationSeries rotation_series(double angle_squared) {
  const double q = angle_squared;
  if (q < 1e-4)
    return {1 - q / 6 * (1 - q / 20), 0.5 - q / 24 * (1 - q / 30), 1.0 / 6 - q / 120 * (1 - q / 42)};
  const double angle = elementary::square_root(q);
  const auto [sine, cosine] = elementary::sine_cosine(angle);
  return {sine / angle, (1 - cosine) / q, (angle - sine) / (q * angle)};
}

// The rotation by the vector (f, c, 0), and the axes about which it turns when f or c grows (the
// columns of the left Jacobian of SO(3)).
struct PlanarBend {
  Matrix3d rotation;
  Vector3d axis_f;
  Vector3d axis_c;
};

PlanarBend planar_bend(double f, double c) {
  const RotationSeries s = rotation_series(f * f + c * c);
  PlanarBend bend;
  bend.rotation << 1 - s.versine * c * c, s.versine * f * c, s.sine * c,  //
      s.versine * f * c, 1 - s.versine * f * f, -s.sine * f,              //
      -s.sine * c, s.sine * f, 1 - s.versine * (f * f + c * c);
  bend.axis_f = {1 - s.remainder * c * c, s.remainder * f * c, -s.versine * c};
  bend.axis_c = {s.remainder * f * c, 1 - s.remainder * f * f, s.versine * f};
  return bend;
}

void add_lateral_share(const Skeleton& s, int joint, const Vector3d& moment, double* gradient) {
  gradient[3 * joint] += s.turn_axis[index(joint)].dot(moment);
  gradient[3 * joint + 1] += s.half_bend_axis[index(joint)].dot(moment);
  gradient[3 * joint + 2] += s.half_side_axis[index(joint)].dot(moment);
}

void add_hanging_share(const Skeleton& s, int joint, const Vector3d& moment, double* gradient) {
  gradient[3 * joint] += s.turn_axis[index(joint)].dot(moment);
  gradient[3 * joint + 1] += s.bend_axis[index(joint)].dot(moment);
  gradient[3 * joint + 2] += s.side_axis[index(joint)].dot(moment);
}

}  // namespace

Skeleton pose_skeleton(const Tuft& tuft, const Variables& x, const Pose<Paper, Handle>& paper_from_handle) {
  Skeleton s;
  s.segments = tuft.segments;
  const Layout layout{tuft.segments};
  Matrix3d frame = paper_from_handle.rotation.toRotationMatrix();
  s.node[0] = paper_from_handle.translation;
  s.lateral[0] = frame.col(0);
  for (int i = 0; i < tuft.segments; ++i) {
    const auto [sine, cosine] = elementary::sine_cosine(x[layout.turn(i)]);
    s.turn_axis[index(i)] = frame.col(2);
    const Vector3d turned_x = cosine * frame.col(0) + sine * frame.col(1);
    const Vector3d turned_y = cosine * frame.col(1) - sine * frame.col(0);
    frame.col(0) = turned_x;
    frame.col(1) = turned_y;
    const double f = x[layout.bend(i)];
    const double c = x[layout.side_bend(i)];
    const PlanarBend half = planar_bend(0.5 * f, 0.5 * c);
    if (i > 0) s.lateral[index(i)] = frame * half.rotation.col(0);
    s.half_bend_axis[index(i)] = 0.5 * (frame * half.axis_f);
    s.half_side_axis[index(i)] = 0.5 * (frame * half.axis_c);
    const PlanarBend whole = planar_bend(f, c);
    s.bend_axis[index(i)] = frame * whole.axis_f;
    s.side_axis[index(i)] = frame * whole.axis_c;
    frame = Matrix3d(frame * whole.rotation);
    s.along[index(i)] = -frame.col(2);
    s.node[index(i + 1)] = s.node[index(i)] + tuft.length_mm[index(i)] * s.along[index(i)];
  }
  s.lateral[index(tuft.segments)] = frame.col(0);
  return s;
}

Pose<Paper, Handle> frame_above(const Tuft& tuft, const Variables& x,
                                const Pose<Paper, Handle>& paper_from_handle, int node) {
  const Layout layout{tuft.segments};
  Pose<Paper, Handle> pose = paper_from_handle;
  Matrix3d frame = pose.rotation.toRotationMatrix();
  for (int i = 0; i < node; ++i) {
    const auto [sine, cosine] = elementary::sine_cosine(x[layout.turn(i)]);
    Matrix3d turned;
    turned << cosine, -sine, 0, sine, cosine, 0, 0, 0, 1;
    frame = Matrix3d(frame * turned * planar_bend(x[layout.bend(i)], x[layout.side_bend(i)]).rotation);
    pose.translation -= tuft.length_mm[index(i)] * frame.col(2);
  }
  pose.rotation = Eigen::Quaterniond(frame).normalized();
  return pose;
}

NodeForces::NodeForces() {
  at_node.fill(Vector3d::Zero());
  at_lateral.fill(Vector3d::Zero());
}

void add_joint_gradient(const Skeleton& s, const NodeForces& forces, Variables& gradient) {
  Vector3d force = Vector3d::Zero();
  Vector3d moment = Vector3d::Zero();  // about the origin
  for (int k = s.segments; k > 0; --k) {
    const Vector3d own = s.lateral[index(k)].cross(forces.at_lateral[index(k)]);
    if (k < s.segments) add_lateral_share(s, k, own, gradient.data());
    force += forces.at_node[index(k)];
    moment += s.node[index(k)].cross(forces.at_node[index(k)]) + own;
    add_hanging_share(s, k - 1, moment - s.node[index(k - 1)].cross(force), gradient.data());
  }
}

void add_joint_gradient(const Skeleton& s, int k, const Vector3d& at_node, const Vector3d& at_lateral,
                        Eigen::Ref<Eigen::RowVectorXd> row) {
  const Vector3d own = s.lateral[index(k)].cross(at_lateral);
  if (k < s.segments) add_lateral_share(s, k, own, row.data());
  for (int joint = k - 1; joint >= 0; --joint)
    add_hanging_share(s, joint, (s.node[index(k)] - s.node[index(joint)]).cross(at_node) + own, row.data());
}

}  // namespace fude
