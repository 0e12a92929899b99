#include "rig/brush_view/posed_brush.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace fude {
namespace {

constexpr double rate_hz = 250;
constexpr double above_mm = 15;  // over where the tuft would touch
constexpr double lowering_s = 0.6;
constexpr double resting_s = 0.2;
constexpr double stroke_s = 1.2;

double ease(double t) {
  const double u = std::clamp(t, 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

Timestamp after_frames(int frames) {
  return Timestamp(Duration(static_cast<std::int64_t>(std::llround(frames * 1e9 / rate_hz))));
}

template <class PoseAt>
void lead(PosedBrush& posed, double seconds, PoseAt pose_at) {
  const int count = static_cast<int>(std::lround(seconds * rate_hz));
  for (int i = 0; i <= count; ++i) {
    BrushInput input;
    input.time.host = after_frames(posed.frames++);
    input.origin = PoseOrigin::measured;
    input.paper_from_handle = pose_at(i / rate_hz);
    const BrushFrame frame = posed.brush.move(input);
    posed.last = frame.solve;
    if (!frame.solve.converged) ++posed.unconverged;
    if (frame.deposit) posed.mark.add(frame.deposit->map);
  }
}

}  // namespace

Pose<Paper, Handle> handle_pose(const Eigen::Vector3d& at_mm, double lean, double towards, double spin) {
  Pose<Paper, Handle> pose;
  pose.rotation = Eigen::AngleAxisd(lean, Eigen::Vector3d(-std::sin(towards), std::cos(towards), 0)) *
                  Eigen::AngleAxisd(spin, Eigen::Vector3d::UnitZ());
  pose.translation = at_mm;
  return pose;
}

Result<PosedBrush> lead_to(const BrushSpec& spec, const Pose<Paper, Handle>& paper_from_handle,
                           const LoadBrush& load) {
  constexpr double farthest_mm = 1000;
  if (!paper_from_handle.translation.allFinite() || !paper_from_handle.rotation.coeffs().allFinite() ||
      paper_from_handle.translation.cwiseAbs().maxCoeff() > farthest_mm)
    return failure(Fault::usage,
                   "a pose is in millimetres and degrees, no farther than 1000 mm from the origin");
  PosedBrush posed{Brush(spec, 1), {}, 0, 0, {}};
  posed.brush.load(load.wetness, load.strength);
  const double start = std::max(paper_from_handle.translation.z(), spec.tuft_length_mm + above_mm);
  lead(posed, lowering_s + resting_s, [&](double t) {
    Pose<Paper, Handle> pose = paper_from_handle;
    const double share = ease(t / lowering_s);
    pose.translation.z() = (1 - share) * start + share * paper_from_handle.translation.z();
    return pose;
  });
  return posed;
}

void draw_stroke(PosedBrush& posed, double mm) {
  const Pose<Paper, Handle> start = posed.brush.state().paper_from_handle;
  const double press_mm = 0.3 * start.translation.z();
  lead(posed, stroke_s, [&](double t) {
    Pose<Paper, Handle> pose = start;
    const double share = ease(t / stroke_s);
    pose.translation.x() += mm * share;
    pose.translation.z() -= press_mm * 4 * share * (1 - share);
    return pose;
  });
}

}  // namespace fude
