// A trial of a real brush and the same trial of its twin: a gesture, the mark that it left on clean paper,
// and how far two marks differ, smoothly.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "signal/pose.h"
#include "sim/brush/brush_spec.h"
#include "sim/brush/mark.h"

namespace fude {

struct HandMoment {
  double t_s = 0;  // from the gesture's beginning
  Pose<Paper, Handle> paper_from_handle;
  std::optional<double> force_mn;  // down on the paper, where it was measured
};

struct TwinTrial {
  std::string name;
  std::vector<HandMoment> hand;  // in order of time; the brush comes to it straight, as after a reshape
  Mark seen;
};

struct TwinMark {
  Mark mark;
  std::vector<double> force_mn;  // down on the paper, at each moment
  int unconverged = 0;
};

// What a wet brush of these parameters leaves. Streaks are left out: the outline is what counts.
TwinMark perform(const BrushSpec& spec, std::span<const HandMoment> hand, double cell_mm = 0.1);

// The places of a grid at which marks are compared, each the mark's cover blurred by a Gaussian. Blurred,
// they differ smoothly however far apart they lie.
class BlurredView {
 public:
  // Over all that `seen` covers and `margin_mm` around it.
  BlurredView(const Mark& seen, double margin_mm);
  // Cover, times the root of the area that a place stands for: the square of the difference of two is an
  // area, mm².
  Eigen::VectorXd of(const Mark& mark) const;

 private:
  Eigen::Vector2d low_;
  int columns_;
  int rows_;
};

// The mean distance between the edges of two marks: the area that one covers and the other does not, over the
// length of the edge of `seen`. Millimetres.
double edge_distance_mm(const Mark& seen, const Mark& made);

}  // namespace fude
