// The ink a tuft carries: patches over its surface, along × around (Chu 2.6, 2.7), and the hair inside it,
// row by row. Volumes in µl.
//
// Water goes from fuller to drier hair, and what is dissolved in it goes along. In wet hair pigment also
// spreads from strong to weak ink. All rates are in seconds and hold whatever the step; what is moved is
// taken from one place and given to another, so totals keep to rounding.
#pragma once

#include <algorithm>
#include <array>
#include <deque>
#include <vector>

#include "signal/ink_event.h"
#include "sim/brush/tuft.h"

namespace fude {

inline constexpr int patches_along = 16;
inline constexpr int patches_around = 16;
inline constexpr int patch_count = patches_along * patches_around;

// The patch at `along` (0 root to 1 tip) and `around` turns from the lateral line (not below −1).
inline int patch_at(double along, double around) {
  const int row = std::clamp(static_cast<int>(along * patches_along), 0, patches_along - 1);
  const int column = static_cast<int>((around + 1) * patches_around) % patches_around;
  return row * patches_around + column;
}

struct LoadedPatch {
  double capacity_ul = 0;
  double water_ul = 0;  // below zero: the paper took more than was set aside for it
  std::array<double, concentrations_per_group> pigment_ul{};
};

using PerPatch = std::array<double, patch_count>;
using PerRow = std::array<double, patches_along>;
using Withdrawal = std::array<PatchExchange, patch_count>;

// What the tuft holds is in the patches, in the hair inside and in what is set aside together.
struct Loading {
  std::array<LoadedPatch, patch_count> patches;
  std::array<LoadedPatch, patches_along> inside;
  double unspread_s = 0;             // for which pigment has still to spread
  std::deque<Withdrawal> set_aside;  // for events that the paper has not yet answered, the oldest first
  bool endless = false;
};

// How fast ink moves in a tuft, per second.
struct HairFlow {
  double moisture_per_s = 0;  // once around, and once along the hair
  double inward_per_s = 0;    // between the surface and the inside
  double along_per_s = 0;     // pigment from a row to the next, in wet hair
  PerRow around_per_s{};      // pigment from a patch to the next around
  PerRow inward_pigment_per_s{};
};
HairFlow flow_in(const Tuft& tuft);

// A dry tuft: capacity shared out by the volume of hair behind each patch.
Loading dry_loading(const Tuft& tuft);

// Fills every part to `wetness` (0 to 1) of its capacity with ink of `strength` (µl of full-strength
// pigment, and glue, in one µl).
void fill(Loading& loading, double wetness, const Concentrations& strength);

// Water in the tuft over its capacity, 0 to 1.
double wetness(const Loading& loading);

// What each patch would offer as it is.
std::vector<InkLoad> offered(const Loading& loading);

// Lets ink move for `step_s`. Totals do not change; an endless tuft stays as it is.
void even_out(Loading& loading, const HairFlow& flow, double step_s);

// The same while the paper draws on the tuft: `demand_ul` is what it would take of each patch in this time
// if that stayed full. Says what each offers, and sets that much aside until the paper answers. So a patch
// that empties in less time than an answer takes runs evenly on what reaches it along the hair.
std::vector<InkLoad> draw(Loading& loading, const HairFlow& flow, double step_s, const PerPatch& demand_ul);

// Books what the paper took and gave back in the oldest event for which ink is set aside, if any is; an
// endless tuft does not change. Patches beyond those of the tuft are an error of the caller
// (std::invalid_argument).
void book(Loading& loading, const Exchange& exchange);

}  // namespace fude
