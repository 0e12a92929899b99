// What of a rig moved, by touches that are off: each way in which it may have, weighed against the others.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace fude {

// `paper`: it slid on its table. `tracker`: it stands otherwise to the paper, in any way; as well the table
// with the paper may have moved. `both`: the tip, and the paper or the tracker.
enum class RigMoved : std::uint8_t { nothing, paper, tracker, tip, both, unclear };

// A touch of a place that was known, in the paper's frame as it was calibrated, mm.
struct KnownTouch {
  Eigen::Vector3d then_mm = Eigen::Vector3d::Zero();  // where it lay
  Eigen::Vector3d now_mm = Eigen::Vector3d::Zero();   // where the tip, as calibrated, is when it touches it
  Eigen::Matrix3d paper_turned = Eigen::Matrix3d::Identity();  // from Tool
  bool height_only = false;                                    // it lay anywhere at that height
};

// About the paper's middle and seen by the painter: right, up (away from the painter), off the surface.
struct RigMotion {
  Eigen::Vector3d shift_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();  // a rotation vector
  Eigen::Vector3d tip_mm = Eigen::Vector3d::Zero();    // of the tip, in Tool
};

struct RigHypothesis {
  RigMoved moved = RigMoved::nothing;
  RigMotion motion;        // the likeliest one
  double probability = 0;  // of all hypotheses
  double leaves_mm = 0;    // root mean square of what it leaves of the touches, as a distance
};

// The most probable first. Each is a Gaussian model: touches are good to 0.35 mm a coordinate, papers move by
// some 20 mm and 5 degrees, tips by 6 mm (as much a paper that does not turn); two things at once are ten
// times rarer than one. Its evidence by Laplace's approximation about the likeliest motion (MacKay 2003,
// chapter 28) pays for every freedom that it takes: a tip that moved has three, a tracker six.
std::vector<RigHypothesis> rig_hypotheses(std::span<const KnownTouch> touches,
                                          const Eigen::Vector3d& paper_middle_mm);

}  // namespace fude
