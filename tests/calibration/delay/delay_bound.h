// What no unbiased estimator of the delay can beat on scripted strokes (Cramér and Rao).
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cmath>

#include "calibration/delay/felt_touch.h"
#include "tests/fakes/scripted_strokes.h"

namespace fude {

// Standard deviation, s, for one who even knows that strokes are eased by cosines and has to find but the
// seven numbers of each: offset, the two heights of touching and, of a sheet that is not levelled, its slope
// are free.
inline double least_sd_s(const ScriptedStrokes& script, const ScriptedStrokes::Seen& seen) {
  using Stroke = ScriptedStrokes::Stroke;
  constexpr std::array<double Stroke::*, 7> numbers{&Stroke::begin_s,     &Stroke::down_s,  &Stroke::still_s,
                                                    &Stroke::up_s,        &Stroke::high_mm, &Stroke::deep_mm,
                                                    &Stroke::next_high_mm};
  using Gradient = Eigen::Matrix<double, 7, 1>;
  const auto gradient = [&](const Stroke& stroke, double t) {
    Gradient g;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const double step = i < 4 ? 1e-5 : 1e-3;
      Stroke more = stroke, less = stroke;
      more.*numbers[i] += step;
      less.*numbers[i] -= step;
      g(Eigen::Index(i)) = (script.height_mm(more, t) - script.height_mm(less, t)) / (2 * step);
    }
    return g;
  };
  Eigen::Matrix<double, 5, 5> information = Eigen::Matrix<double, 5, 5>::Zero();
  for (std::size_t k = 0; k < seen.strokes.size(); ++k) {
    const Stroke& stroke = seen.strokes[k];
    Eigen::Matrix<double, 7, 7> known = 1e-9 * Eigen::Matrix<double, 7, 7>::Identity();
    for (const double at : seen.path.t_s) {
      const double t = at + script.offset_s + script.drift * at;
      if (t < stroke.begin_s || t > stroke.end_s()) continue;
      const Gradient g = gradient(stroke, t);
      known += g * g.transpose() / (script.noise_mm * script.noise_mm);
    }
    for (const bool down : {true, false}) {
      const Touch& touch = seen.touches[2 * k + (down ? 0 : 1)];
      const double t = touch.middle_s();
      const Gradient g = gradient(stroke, t);
      constexpr double step_s = 1e-5;
      const double rate =
          (script.height_mm(stroke, t + step_s) - script.height_mm(stroke, t - step_s)) / (2 * step_s);
      const FeltTouch felt{std::abs(rate) * touch.early_s / 2, std::sqrt(g.dot(known.ldlt().solve(g)))};
      const double share = (t - stroke.begin_s) / (stroke.end_s() - stroke.begin_s);
      const Eigen::Vector2d place = stroke.from_mm + share * (stroke.to_mm - stroke.from_mm);
      Eigen::Matrix<double, 5, 1> row;
      row << rate, double(down), double(!down), place;
      information += felt.information() * row * row.transpose();
    }
  }
  return std::sqrt(information.inverse()(0, 0));
}

}  // namespace fude
