#include "app/studio/care_choice.h"

namespace fude {
namespace {

constexpr float belly_share = 0.1F;  // of the colour, at the root of a gradient
constexpr float dip_s = 0.5F;
constexpr float rinse_s = 1;
constexpr float blot_s = 0.2F;
constexpr float wiped = 0.6F;

}  // namespace

std::optional<BrushCare> care_for(StudioKey key, const CareChoice& choice) {
  Concentrations colour{};
  colour[choice.pigment] = choice.strength;
  colour[glue_channel] = choice.glue;
  Concentrations pale = colour;
  pale[choice.pigment] *= belly_share;
  switch (key) {
    case StudioKey::load:
      return LoadBrush{choice.wetness, colour};
    case StudioKey::gradient:
      return GradeBrush{{{0, choice.wetness, pale}, {1, choice.wetness, colour}}, {}};
    case StudioKey::dip:
      return DipBrush{choice.depth_mm, dip_s, colour};
    case StudioKey::rinse:
      return RinseBrush{rinse_s};
    case StudioKey::wipe:
      return WipeBrush{wiped};
    case StudioKey::blot:
      return BlotBrush{blot_s, std::nullopt};
    case StudioKey::roll:
      return RollBrush{1};
    default:
      return std::nullopt;
  }
}

}  // namespace fude
