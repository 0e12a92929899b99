#include "sim/brush/arrangement.h"

#include <algorithm>
#include <numbers>

#include "signal/elementary.h"
#include "sim/brush/section.h"
#include "sim/brush/seeded.h"
#include "sim/brush/skeleton.h"

namespace fude {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

auto index(std::int64_t i) { return static_cast<std::size_t>(i); }

Eigen::Quaterniond about(int axis, double angle) {
  const auto [sine, cosine] = elementary::sine_cosine(0.5 * angle);
  Eigen::Quaterniond q(cosine, 0, 0, 0);
  q.vec()[axis] = sine;
  return q;
}

// Half the width of a slice of a row, over half the width of the row.
double slice_share(const BrushSpec& spec) { return 1 / spec.spines; }

}  // namespace

std::vector<TuftRoot> arrangement(const BrushSpec& spec, std::uint64_t seed) {
  const int count = static_cast<int>(spec.spines);
  if (count == 1) return {TuftRoot{}};
  std::vector<TuftRoot> roots;
  Seeded random(seed);
  for (int i = 0; i < count; ++i) {
    TuftRoot root;
    root.at = {(2 * i + 1) * slice_share(spec) - 1, 0};
    root.lean_rad = {spec.fan_rad * root.at.x(), 0};
    root.lean_rad += spec.unruly_rad * Vector2d(random.between(-1, 1), random.between(-1, 1));
    root.hair = slice_share(spec);
    roots.push_back(root);
  }
  return roots;
}

BrushSpec hair_of(const BrushSpec& from, const TuftRoot& root) {
  BrushSpec spec = from;
  spec.bend_stiffness *= root.hair;
  spec.side_hair_stiffness *= root.hair;
  spec.stretch_stiffness *= root.hair;
  spec.adhesion_mn *= root.hair;
  spec.pore_strength_mn *= root.hair;
  spec.pore_pressure_lead_mm /= root.hair;
  spec.hair_count = std::max(8.0, from.hair_count * root.hair);
  spec.root_radius_mm *= root.width;
  spec.belly_radius_mm *= root.width;
  spec.tip_radius_mm *= root.width;
  if (spec.spines > 1) spec.spread = false;  // short hair in a row hardly pushes sideways (Chu 2.8)
  return spec;
}

Pose<Paper, Handle> root_pose(const BrushSpec& spec, const TuftRoot& root,
                              const Pose<Paper, Handle>& paper_from_handle) {
  if (root.at.isZero() && root.lean_rad.isZero()) return paper_from_handle;
  const double half_width = spec.spines > 1 ? 0.5 * spec.row_width_mm : spec.root_radius_mm;
  Pose<Handle, Handle> on_handle;
  on_handle.translation = {half_width * root.at.x(), spec.root_radius_mm * root.at.y(), 0};
  on_handle.rotation = about(1, -root.lean_rad.x()) * about(0, root.lean_rad.y());
  return paper_from_handle * on_handle;
}

Pose<Paper, Handle> root_pose(const Tuft& parent, const TuftState& state, const TuftRoot& root) {
  const Skeleton skeleton = pose_skeleton(parent, state.x, state.paper_from_handle);
  const Layout layout{parent.segments};
  const auto k = static_cast<int>(root.node);
  const Section section = section_of(parent.radius_mm[index(k)], state.x[layout.stretch(k, 0)],
                                     state.x[layout.stretch(k, 1)]);
  const Eigen::Vector3d lateral = skeleton.lateral[index(k)];
  const Eigen::Vector3d along = (skeleton.along[index(k - 1)] + skeleton.along[index(k)]).normalized();
  Pose<Paper, Handle> pose = frame_above(parent, state.x, state.paper_from_handle, k);
  const double across = (root.at.x() > 0 ? section.major_a : section.major_b) * root.at.x();
  pose.translation += across * lateral + section.minor * root.at.y() * along.cross(lateral);
  return pose;
}

PatchesOfBrush patches_of(const BrushSpec& spec, const TuftRoot& root) {
  PatchesOfBrush patches;
  double above = 0;  // share of the parent's length above the tuft
  if (root.parent >= 0) {
    const Tuft parent = make_tuft(spec);
    for (std::int64_t i = 0; i < root.node; ++i) above += parent.length_mm[index(i)];
    above /= spec.tuft_length_mm;
  }
  // The section of the tuft within the unit disc of the brush's.
  const bool whole = root.at.isZero() && root.width == 1 && root.hair == 1;
  const double half_across = spec.spines > 1 ? slice_share(spec) : root.width;
  const double half_through =
      spec.spines > 1 ? elementary::square_root(1 - root.at.x() * root.at.x()) : root.width;
  for (int i = 0; i < patches_along; ++i)
    for (int j = 0; j < patches_around; ++j) {
      const double along = above + (1 - above) * (i + 0.5) / patches_along;
      double around = (j + 0.5) / patches_around;
      if (!whole) {
        const auto [sine, cosine] = elementary::sine_cosine(2 * pi * around);
        around = elementary::arctangent(root.at.y() + half_through * sine, root.at.x() + half_across * cosine) /
                 (2 * pi);
      }
      patches[index(i * patches_around + j)] = static_cast<std::uint16_t>(patch_at(along, around));
    }
  return patches;
}

}  // namespace fude
