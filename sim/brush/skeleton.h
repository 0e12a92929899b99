// Forward kinematics of the spine and its lateral lines, and the way back: from forces on nodes to
// the gradient in the joints.
//
// A joint turns about the segment above it (ψ), then bends by the rotation vector (φ, χ, 0): φ about
// the lateral line, χ across it. The bend angle is √(φ² + χ²), so nothing is singular where the tuft
// is straight. The pair of thesis 2.4.1 (turn, bend) is (ψ, φ); χ lets a straight tuft bend sideways
// without turning first. Half the bend puts the lateral line on the joint-bisecting plane.
#pragma once

#include <Eigen/Core>

#include "signal/pose.h"
#include "sim/brush/tuft.h"

namespace fude {

// Where the unknowns stand in the vector: three angles a joint, two stretches a node between root
// and tip, and how far the tip has broken through the blocking plane.
struct Layout {
  int segments = 0;
  int turn(int joint) const { return 3 * joint; }
  int bend(int joint) const { return 3 * joint + 1; }
  int side_bend(int joint) const { return 3 * joint + 2; }
  int stretch(int node, int side) const { return 3 * segments + 2 * (node - 1) + side; }
  int yielding() const { return 3 * segments + 2 * (segments - 1); }
  int size() const { return yielding() + 1; }
};

inline constexpr int max_variables = 3 * max_segments + 2 * (max_segments - 1) + 1;
using Variables = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_variables, 1>;

struct Skeleton {
  int segments = 0;
  PerNode<Eigen::Vector3d> node;      // mm, on the paper frame
  PerNode<Eigen::Vector3d> lateral;   // unit lateral line of nodes 1 to n
  PerSegment<Eigen::Vector3d> along;  // unit direction of a segment, towards the tip
  // Axes about which a joint's three unknowns rotate all that hangs from it, and (half) its own
  // lateral line.
  PerSegment<Eigen::Vector3d> turn_axis;
  PerSegment<Eigen::Vector3d> bend_axis;
  PerSegment<Eigen::Vector3d> side_axis;
  PerSegment<Eigen::Vector3d> half_bend_axis;
  PerSegment<Eigen::Vector3d> half_side_axis;
};

Skeleton pose_skeleton(const Tuft& tuft, const Variables& x, const Pose<Paper, Handle>& paper_from_handle);

// The frame of the hair above joint `node`, at that node: a tuft that hangs there takes it for its handle.
Pose<Paper, Handle> frame_above(const Tuft& tuft, const Variables& x,
                                const Pose<Paper, Handle>& paper_from_handle, int node);

// What pulls at the nodes: ∂E/∂node and ∂E/∂lateral.
struct NodeForces {
  PerNode<Eigen::Vector3d> at_node;
  PerNode<Eigen::Vector3d> at_lateral;
  NodeForces();
};

// Adds the gradient of a function of the nodes with respect to the joint angles.
void add_joint_gradient(const Skeleton& skeleton, const NodeForces& forces, Variables& gradient);

// The same for a function of node k alone (a row of the constraints); `row` is written from 0 up to
// the last joint that moves the node.
void add_joint_gradient(const Skeleton& skeleton, int k, const Eigen::Vector3d& at_node,
                        const Eigen::Vector3d& at_lateral, Eigen::Ref<Eigen::RowVectorXd> row);

}  // namespace fude
