// Where the sheet lies in the window. Window coordinates are pixels, y downwards; paper is millimetres, y
// upwards.
#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace fude {

struct View {
  Eigen::Vector2d centre_mm = Eigen::Vector2d::Zero();  // of the window, on the paper
  double pixels_per_mm = 1;
  Eigen::Vector2d window = Eigen::Vector2d(1, 1);  // pixels

  Eigen::Vector2d to_window(const Eigen::Vector2d& mm) const {
    const Eigen::Vector2d d = (mm - centre_mm) * pixels_per_mm;
    return {0.5 * window.x() + d.x(), 0.5 * window.y() - d.y()};
  }
  Eigen::Vector2d to_paper(const Eigen::Vector2d& pixels) const {
    const Eigen::Vector2d d = (pixels - 0.5 * window) / pixels_per_mm;
    return centre_mm + Eigen::Vector2d(d.x(), -d.y());
  }

  // The whole sheet, with a little table around it.
  void fit(const Eigen::Vector2d& sheet_mm) {
    centre_mm = 0.5 * sheet_mm;
    pixels_per_mm = 0.94 * std::min(window.x() / sheet_mm.x(), window.y() / sheet_mm.y());
  }
  // The paper under `pixels` stays there.
  void zoom(double factor, const Eigen::Vector2d& pixels) {
    const Eigen::Vector2d held = to_paper(pixels);
    pixels_per_mm = std::clamp(pixels_per_mm * factor, 0.2, 400.0);
    centre_mm += held - to_paper(pixels);
  }
  void pan(const Eigen::Vector2d& pixels) {
    centre_mm += Eigen::Vector2d(-pixels.x(), pixels.y()) / pixels_per_mm;
  }
};

}  // namespace fude
