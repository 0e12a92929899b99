// How a brush is made of tufts: where each hangs and what hair it has (Chu 2.5.7, 2.8).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "signal/pose.h"
#include "sim/brush/brush_spec.h"
#include "sim/brush/loading.h"
#include "sim/brush/tuft_state.h"

namespace fude {

inline constexpr int most_tufts = 16;

// Where a tuft hangs: from the handle, or from a node of a tuft that stands before it in the brush.
struct TuftRoot {
  std::int64_t parent = -1;  // −1: the handle
  std::int64_t node = 0;     // of the parent
  // In the section of the brush or of the parent: across (along the lateral line) and through it, over its
  // half axes.
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  Eigen::Vector2d lean_rad = Eigen::Vector2d::Zero();  // across and through, of a tuft on the handle
  double width = 1;                                    // radius over that of the hair it is taken from
  double hair = 1;                                     // its share of that hair
};

// One tuft of a brush as it stands.
struct BrushTuft {
  TuftRoot root;
  TuftState state;
};

// The tufts of a wet brush: one, or `spines` of them side by side; what is unruly about them is from the seed.
std::vector<TuftRoot> arrangement(const BrushSpec& spec, std::uint64_t seed);

// What a tuft is made of that hangs so: of the brush's own spec, or of that of its parent.
BrushSpec hair_of(const BrushSpec& from, const TuftRoot& root);

// The pose from which a tuft hangs, given that of the handle.
Pose<Paper, Handle> root_pose(const BrushSpec& spec, const TuftRoot& root,
                              const Pose<Paper, Handle>& paper_from_handle);
// The same of a tuft that hangs from `parent`: on the plane that halves the joint, in the section there.
Pose<Paper, Handle> root_pose(const Tuft& parent, const TuftState& state, const TuftRoot& root);

// From which patch of the brush each patch of the tuft has its ink.
using PatchesOfBrush = std::array<std::uint16_t, patch_count>;
PatchesOfBrush patches_of(const BrushSpec& spec, const TuftRoot& root);

}  // namespace fude
