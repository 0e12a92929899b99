// How ink comes into a tuft and out of it besides painting: ramps, dips, rinsing, wiping, blotting and
// rolling (Chu 2.6). Pure steps on a Loading; seconds are of the clock of the painting and never of its
// frames.
#pragma once

#include "signal/action.h"
#include "sim/brush/loading.h"
#include "sim/brush/tuft.h"
#include "sim/brush/tuft_surface.h"

namespace fude {

// Where a tuft stands in its brush: from −1, the far side, to 1.
struct AcrossBrush {
  double from = -1;
  double to = 1;
};

// Fills the tuft by ramps. The lateral line of the tuft runs across.
void grade(Loading& loading, const GradeBrush& ramps, const AcrossBrush& across);

// Share of each patch, and of each row inside, that is in the ink, 0 to 1.
struct Immersion {
  PerPatch patches{};
  PerRow inside{};
};

// Of a tuft that hangs straight down with its tip `depth_mm` below the surface.
Immersion hung_in(const Tuft& tuft, double depth_mm);

// Of a tuft as it stands: what of it is below the level.
Immersion immersed_below(const TuftSurface& surface, double level_mm);

// What is immersed nears full hair with ink of this strength at `per_s`, while ink moves on in the tuft.
void steep(Loading& loading, const HairFlow& flow, const Immersion& immersed, const Concentrations& strength,
           double per_s, double seconds);

// A cloth that touches this share of each patch takes the water and what is in it at `per_s`, while ink moves
// on in the tuft. Gives what it took.
PatchExchange blot(Loading& loading, const HairFlow& flow, const PerPatch& touched, double per_s,
                   double seconds);

// Share of each patch on the side that looks to `side`, turns about the tuft; the whole tuft where none is
// named.
PerPatch facing(std::optional<double> side);

// Takes off what is above `fullest` (0 to 1) of each part's capacity, and the pigment in it.
PatchExchange wipe(Loading& loading, double fullest);

// The sides mix: after each turn a third of what told one side from another is left.
void roll(Loading& loading, double turns);

// What a brush may go to beside the paper: ink or water so deep, a dry cloth, a rim to stroke it off on.
struct Bath {
  Concentrations strength{};
  double depth_mm = 20;
};
struct Cloth {};
struct Rim {
  double fullest = 0.6;
};
using PaletteSpot = std::variant<Bath, Cloth, Rim>;

// The tuft for `seconds` at a spot, where `immersed` of it is below the surface.
void stay_at(Loading& loading, const Tuft& tuft, const HairFlow& flow, const PaletteSpot& spot,
             const Immersion& immersed, double seconds);

// All that a painter can do to the ink of one tuft.
void tend(Loading& loading, const Tuft& tuft, const HairFlow& flow, const BrushCare& care,
          const AcrossBrush& across);

}  // namespace fude
