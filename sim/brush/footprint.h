// From the tuft's surface at a few times to the map of what it newly covered and how long it touched
// (Chu 2.7). Between two times the surface is carried along in a straight line, in steps finer than
// what a fast stroke would leave gaps between.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "signal/ink_event.h"
#include "sim/brush/hair_texture.h"
#include "sim/brush/tuft_surface.h"

namespace fude {

struct TimedSurface {
  TuftSurface surface;
  double since_last_s = 0;  // from the surface before it
};

// The footprint swept from `before` through `after`, in order. `before` empty: the tuft comes from
// nowhere, all it covers is new, and nothing is known of the time before. `loads` are those of the
// patches that the map names. None where nothing touched.
std::optional<FootprintMap> sweep(const TuftSurface& before, std::span<const TimedSurface> after,
                                  double cell_mm, const HairTexture& texture,
                                  const std::vector<InkLoad>& loads);

}  // namespace fude
