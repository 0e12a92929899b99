// What the painter's keys do to the ink in the brush: with the colour and the amounts chosen in the panel.
#pragma once

#include <cstddef>
#include <optional>

#include "app/studio/script.h"
#include "signal/action.h"

namespace fude {

struct CareChoice {
  std::size_t pigment = 0;  // of the palette
  float strength = 1.2F;    // of the colour
  float glue = 0.4F;
  float wetness = 0.8F;
  float depth_mm = 8;  // of a dip
};

// None: the key does something else.
std::optional<BrushCare> care_for(StudioKey key, const CareChoice& choice);

}  // namespace fude
