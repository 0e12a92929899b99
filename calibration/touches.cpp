#include "calibration/touches.h"

namespace fude {

std::vector<TipPoint> resting_places(std::span<const TipPoint> way, const RestingTip& rest) {
  std::vector<TipPoint> touches;
  for (std::size_t first = 0; first < way.size();) {
    Eigen::Vector3d sum = way[first].point_m;
    std::size_t end = first + 1;
    for (; end < way.size(); ++end) {
      const Eigen::Vector3d mean = sum / double(end - first);
      if ((way[end].point_m - mean).norm() > rest.nearest_m || way[end].time < way[end - 1].time) break;
      sum += way[end].point_m;
    }
    const std::size_t samples = end - first;
    if (samples < 3 || way[end - 1].time - way[first].time < rest.shortest) {
      ++first;
      continue;
    }
    const TipPoint touch{way[first].time, sum / double(samples), way[first].number};
    const bool same =
        !touches.empty() && (touches.back().point_m - touch.point_m).norm() < 2 * rest.nearest_m;
    if (!same) touches.push_back(touch);
    first = end;
  }
  return touches;
}

}  // namespace fude
