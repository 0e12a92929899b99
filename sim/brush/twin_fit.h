// The twin of a real brush: the parameters with which the simulated tuft leaves the marks that the real one
// left, by nonlinear least squares over whole gestures (Levenberg-Marquardt, central differences, several
// starts).
//
// Lengths and radii are measured and stay. Footprints bear no force: multiply every stiffness by one number,
// and they are the same. So what they tell are ratios, and bend_stiffness stays as it was unless forces were
// measured.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "sim/brush/brush_spec.h"
#include "sim/brush/twin_trial.h"

namespace fude {

// What is fitted, and the gesture that shows it.
struct TwinParameter {
  std::string_view id;  // of brush_spec.inl
  double BrushSpec::*member;
  std::string_view shown_by;
};
inline constexpr int twin_parameter_count = 6;
std::span<const TwinParameter, twin_parameter_count> twin_parameters();

using TwinVector = Eigen::Matrix<double, twin_parameter_count, 1>;

struct TwinFit {
  BrushSpec spec;  // with what was found
  // Relative, one standard error: the larger of the least squares' own and of leaving out one trial after
  // another.
  TwinVector standard_error = TwinVector::Zero();
  // By how much the marks change, in mm, where a parameter alone changes e-fold and all others make up for it
  // as well as they can.
  TwinVector shown_mm = TwinVector::Zero();
  TwinVector singular_mm = TwinVector::Zero();  // of the derivatives by the logarithms, falling
  std::vector<double> edge_mm;                  // of each trial: distance of its edges
  std::vector<double> held_out_mm;              // by a fit of the others, in one linear step
  double started_mm = 0;                        // the mean edge distance before
  double starts_differ = 0;                     // the most that two starts disagree, relative; 0 of one
  int simulated = 0;                            // gestures
  int unconverged = 0;                          // frames, at the end
  struct Force {
    double scale = 1;      // of every stiffness
    double rms_share = 0;  // of what is left, over the rms of what was measured
    std::size_t samples = 0;
  };
  std::optional<Force> force;
};

// At least one trial, each with a mark and a gesture. `known` has the measured shape, and is where the first
// start stands. `starts`: how many places the search begins at. Told the share done; may be empty.
TwinFit fit_twin(const BrushSpec& known, std::span<const TwinTrial> trials, int starts,
                 const std::function<void(double)>& progress);

// The brush with every force, stiffness and strength `scale` times as large: its marks are the same.
BrushSpec stiffened(BrushSpec spec, double scale);

}  // namespace fude
