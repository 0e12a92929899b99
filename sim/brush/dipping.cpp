#include "sim/brush/dipping.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "signal/elementary.h"

namespace fude {
namespace {

constexpr double part_s = 0.02;   // in which hair takes up ink before it moves on
constexpr double longest_s = 60;  // of one dip: after it nothing changes any more
constexpr double swished = 2;     // rinsing moves the water: that much faster than standing in it

std::size_t patch_index(int along, int around) {
  return static_cast<std::size_t>(along * patches_around + around);
}

// 1 where the lateral line points, −1 opposite.
double across_of(int around) {
  return elementary::cosine(2 * std::numbers::pi * (around + 0.5) / patches_around);
}

struct Ink {
  double wetness = 0;
  std::array<double, concentrations_per_group> strength{};
};

Ink mixed(const Ink& a, const Ink& b, double t) {
  Ink ink{a.wetness + t * (b.wetness - a.wetness), {}};
  for (std::size_t c = 0; c < concentrations_per_group; ++c)
    ink.strength[c] = a.strength[c] + t * (b.strength[c] - a.strength[c]);
  return ink;
}

Ink ink_of(const LoadStop& stop) {
  Ink ink{static_cast<double>(stop.wetness), {}};
  for (std::size_t c = 0; c < concentrations_per_group; ++c)
    ink.strength[c] = static_cast<double>(stop.strength[c]);
  return ink;
}

Ink ink_at(std::span<const LoadStop> ramp, double along) {
  const auto after = std::ranges::upper_bound(ramp, static_cast<float>(along), {}, &LoadStop::along);
  if (after == ramp.begin()) return ink_of(ramp.front());
  if (after == ramp.end()) return ink_of(ramp.back());
  const LoadStop& before = *(after - 1);
  const double length = static_cast<double>(after->along) - static_cast<double>(before.along);
  const double t = (along - static_cast<double>(before.along)) / length;
  return mixed(ink_of(before), ink_of(*after), std::clamp(t, 0.0, 1.0));
}

void set(LoadedPatch& part, const Ink& ink) {
  part.water_ul = part.capacity_ul * std::clamp(ink.wetness, 0.0, 1.0);
  for (std::size_t c = 0; c < concentrations_per_group; ++c)
    part.pigment_ul[c] = part.water_ul * ink.strength[c];
}

// Nears full hair with ink of this strength by `share` of the way.
void take_up(LoadedPatch& part, const Concentrations& strength, double share) {
  part.water_ul += share * (part.capacity_ul - part.water_ul);
  for (std::size_t c = 0; c < concentrations_per_group; ++c)
    part.pigment_ul[c] += share * (part.capacity_ul * static_cast<double>(strength[c]) - part.pigment_ul[c]);
}

// Takes `share` of what is in the part.
void give_up(LoadedPatch& part, double share, PatchExchange& taken) {
  if (part.water_ul <= 0) return;
  const double water = share * part.water_ul;
  part.water_ul -= water;
  taken.water_ul += water;
  for (std::size_t c = 0; c < concentrations_per_group; ++c) {
    const double pigment = share * part.pigment_ul[c];
    part.pigment_ul[c] -= pigment;
    taken.pigment_ul[c] += pigment;
  }
}

// Calls step(seconds) for each part of the time.
template <class Step>
void in_parts(double seconds, Step step) {
  const double whole = std::clamp(seconds, 0.0, longest_s);
  const int parts = static_cast<int>(std::ceil(whole / part_s - 1e-9));
  for (int k = 0; k < parts; ++k) step(whole / parts);
}

double nearing(double per_s, double seconds) { return 1 - elementary::exponential(-per_s * seconds); }

// Height of the surface at the middle of a patch around a section; `around` runs as in the rings of a
// contact.
double height_at(const Station& s, int around) {
  const elementary::SineCosine turn =
      elementary::sine_cosine(2 * std::numbers::pi * (around + 0.5) / patches_around);
  const double major = turn.cosine > 0 ? s.major_a : s.major_b;
  return s.centre.z() + turn.cosine * major * s.lateral.z() +
         (s.flipped ? -turn.sine : turn.sine) * s.minor * s.down.z();
}

// Of the way from one height to the other, what is below the level.
double share_below(double a, double b, double level) {
  const double low = std::min(a, b);
  const double high = std::max(a, b);
  if (level <= low) return 0;
  if (level >= high) return 1;
  return (level - low) / (high - low);
}

Station station_at(const TuftSurface& surface, double along) {
  const auto after = std::ranges::upper_bound(surface, along, {}, &Station::along);
  if (after == surface.begin()) return surface.front();
  if (after == surface.end()) return surface.back();
  const Station& a = *(after - 1);
  const Station& b = *after;
  const double t = (along - a.along) / (b.along - a.along);
  Station s = t < 0.5 ? a : b;
  s.centre = (1 - t) * a.centre + t * b.centre;
  s.major_a = (1 - t) * a.major_a + t * b.major_a;
  s.major_b = (1 - t) * a.major_b + t * b.major_b;
  s.minor = (1 - t) * a.minor + t * b.minor;
  return s;
}

void rinse(Loading& loading, const Tuft& tuft, const HairFlow& flow, double seconds) {
  Immersion whole;
  whole.patches.fill(1);
  whole.inside.fill(1);
  steep(loading, flow, whole, {}, swished * tuft.spec.absorbency_per_s, seconds);
}

}  // namespace

void grade(Loading& loading, const GradeBrush& ramps, const AcrossBrush& across) {
  if (ramps.side.empty()) return;
  const std::span<const LoadStop> far_side = ramps.far_side.empty() ? ramps.side : ramps.far_side;
  for (int i = 0; i < patches_along; ++i) {
    const double along = (i + 0.5) / patches_along;
    const Ink near_ink = ink_at(ramps.side, along);
    const Ink far_ink = ink_at(far_side, along);
    const auto at = [&](double place) {
      const double in_brush = across.from + 0.5 * (place + 1) * (across.to - across.from);
      return mixed(far_ink, near_ink, 0.5 * (in_brush + 1));
    };
    set(loading.inside[static_cast<std::size_t>(i)], at(0));
    for (int j = 0; j < patches_around; ++j) set(loading.patches[patch_index(i, j)], at(across_of(j)));
  }
}

Immersion hung_in(const Tuft& tuft, double depth_mm) {
  Immersion immersed;
  const double row_mm = tuft.spec.tuft_length_mm / patches_along;
  for (int i = 0; i < patches_along; ++i) {
    const double below_mm = depth_mm - (patches_along - 1 - i) * row_mm;
    const double share = std::clamp(below_mm / row_mm, 0.0, 1.0);
    immersed.inside[static_cast<std::size_t>(i)] = share;
    for (int j = 0; j < patches_around; ++j) immersed.patches[patch_index(i, j)] = share;
  }
  return immersed;
}

Immersion immersed_below(const TuftSurface& surface, double level_mm) {
  Immersion immersed;
  if (surface.empty()) return immersed;
  for (int i = 0; i < patches_along; ++i) {
    const Station head = station_at(surface, static_cast<double>(i) / patches_along);
    const Station tail = station_at(surface, (i + 1.0) / patches_along);
    immersed.inside[static_cast<std::size_t>(i)] = share_below(head.centre.z(), tail.centre.z(), level_mm);
    for (int j = 0; j < patches_around; ++j)
      immersed.patches[patch_index(i, j)] = share_below(height_at(head, j), height_at(tail, j), level_mm);
  }
  return immersed;
}

void steep(Loading& loading, const HairFlow& flow, const Immersion& immersed, const Concentrations& strength,
           double per_s, double seconds) {
  in_parts(seconds, [&](double s) {
    const double share = nearing(per_s, s);
    for (std::size_t k = 0; k < patch_count; ++k)
      take_up(loading.patches[k], strength, share * immersed.patches[k]);
    for (std::size_t i = 0; i < patches_along; ++i)
      take_up(loading.inside[i], strength, share * immersed.inside[i]);
    even_out(loading, flow, s);
  });
}

PatchExchange blot(Loading& loading, const HairFlow& flow, const PerPatch& touched, double per_s,
                   double seconds) {
  PatchExchange taken;
  in_parts(seconds, [&](double s) {
    const double share = nearing(per_s, s);
    for (std::size_t k = 0; k < patch_count; ++k) give_up(loading.patches[k], share * touched[k], taken);
    even_out(loading, flow, s);
  });
  return taken;
}

PerPatch facing(std::optional<double> side) {
  PerPatch share{};
  for (int i = 0; i < patches_along; ++i)
    for (int j = 0; j < patches_around; ++j) {
      const double off = (j + 0.5) / patches_around - side.value_or(0);
      share[patch_index(i, j)] = side ? std::max(0.0, elementary::cosine(2 * std::numbers::pi * off)) : 1.0;
    }
  return share;
}

PatchExchange wipe(Loading& loading, double fullest) {
  PatchExchange taken;
  const auto squeeze = [&](LoadedPatch& part) {
    const double most = part.capacity_ul * std::clamp(fullest, 0.0, 1.0);
    if (part.water_ul > most) give_up(part, 1 - most / part.water_ul, taken);
  };
  std::ranges::for_each(loading.patches, squeeze);
  std::ranges::for_each(loading.inside, squeeze);
  return taken;
}

void roll(Loading& loading, double turns) {
  constexpr double per_turn = 1.0986122886681098;  // ln 3
  const double share = nearing(per_turn, std::max(turns, 0.0));
  for (int i = 0; i < patches_along; ++i) {
    LoadedPatch mean{};
    for (int j = 0; j < patches_around; ++j) {
      const LoadedPatch& side = loading.patches[patch_index(i, j)];
      mean.water_ul += side.water_ul / patches_around;
      for (std::size_t c = 0; c < concentrations_per_group; ++c)
        mean.pigment_ul[c] += side.pigment_ul[c] / patches_around;
    }
    for (int j = 0; j < patches_around; ++j) {
      LoadedPatch& side = loading.patches[patch_index(i, j)];
      side.water_ul += share * (mean.water_ul - side.water_ul);
      for (std::size_t c = 0; c < concentrations_per_group; ++c)
        side.pigment_ul[c] += share * (mean.pigment_ul[c] - side.pigment_ul[c]);
    }
  }
}

void stay_at(Loading& loading, const Tuft& tuft, const HairFlow& flow, const PaletteSpot& spot,
             const Immersion& immersed, double seconds) {
  if (const auto* bath = std::get_if<Bath>(&spot))
    steep(loading, flow, immersed, bath->strength, tuft.spec.absorbency_per_s, seconds);
  if (std::holds_alternative<Cloth>(spot))
    blot(loading, flow, immersed.patches, tuft.spec.absorbency_per_s, seconds);
  const bool touches = std::ranges::any_of(immersed.patches, [](double share) { return share > 0; });
  if (const auto* rim = std::get_if<Rim>(&spot); rim && touches) wipe(loading, rim->fullest);
}

void tend(Loading& loading, const Tuft& tuft, const HairFlow& flow, const BrushCare& care,
          const AcrossBrush& across) {
  struct Tending {
    Loading& loading;
    const Tuft& tuft;
    const HairFlow& flow;
    const AcrossBrush& across;
    void operator()(const LoadBrush& load) const {
      fill(loading, static_cast<double>(load.wetness), load.strength);
    }
    void operator()(const GradeBrush& ramps) const { grade(loading, ramps, across); }
    void operator()(const DipBrush& dip) const {
      steep(loading, flow, hung_in(tuft, static_cast<double>(dip.depth_mm)), dip.strength,
            tuft.spec.absorbency_per_s, static_cast<double>(dip.seconds));
    }
    void operator()(const RinseBrush& r) const { rinse(loading, tuft, flow, static_cast<double>(r.seconds)); }
    void operator()(const WipeBrush& w) const { wipe(loading, static_cast<double>(w.fullest)); }
    void operator()(const BlotBrush& b) const {
      const auto side = b.side ? std::optional(static_cast<double>(*b.side)) : std::nullopt;
      blot(loading, flow, facing(side), tuft.spec.absorbency_per_s, static_cast<double>(b.seconds));
    }
    void operator()(const RollBrush& r) const { roll(loading, static_cast<double>(r.turns)); }
  };
  std::visit(Tending{loading, tuft, flow, across}, care);
}

}  // namespace fude
