#include "sim/brush/loading.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "signal/elementary.h"

namespace fude {
namespace {

constexpr double inside_share = 0.4;    // of the hair: that within 0.63 of the radius
constexpr double drawn_part_s = 0.001;  // a longer step in which the paper draws is taken in parts
constexpr int most_drawn_parts = 256;
constexpr double spread_part_s = 0.02;     // pigment spreads slowly: it waits until so much time has passed
constexpr double least_difference = 1e-7;  // of the fill: less than it moves nothing

std::size_t patch_index(int along, int around) {
  return static_cast<std::size_t>(along * patches_around + around);
}

// The share of a difference between two equal places that has gone over when each feeds the other at `per_s`.
double evened(double per_s, double step_s) {
  return 0.5 * (1 - elementary::exponential(-2 * per_s * step_s));
}

// Moves pigment between wet places from strong to weak ink: the share of the difference that the drier one
// can hold.
void spread_pigment(LoadedPatch& a, LoadedPatch& b, double share) {
  if (a.water_ul <= 0 || b.water_ul <= 0) return;
  const bool a_is_drier = a.water_ul < b.water_ul;
  // The weaker of the two waters, over each of them.
  const double part_a = a_is_drier ? 1 : b.water_ul / a.water_ul;
  const double part_b = a_is_drier ? a.water_ul / b.water_ul : 1;
  for (std::size_t c = 0; c < concentrations_per_group; ++c) {
    const double flow = share * (part_a * a.pigment_ul[c] - part_b * b.pigment_ul[c]);
    a.pigment_ul[c] -= flow;
    b.pigment_ul[c] += flow;
  }
}

// Hands `flow` µl and the pigment in it from one patch to the next; a patch may owe water, never pigment.
void hand_on(LoadedPatch& from, LoadedPatch& to, double flow) {
  const double part = from.water_ul > flow ? flow / from.water_ul : 1;
  from.water_ul -= flow;
  to.water_ul += flow;
  for (std::size_t c = 0; c < concentrations_per_group; ++c) {
    const double carried = part * std::max(0.0, from.pigment_ul[c]);
    from.pigment_ul[c] -= carried;
    to.pigment_ul[c] += carried;
  }
}

// Moves the share of the difference in fill that one link passes, from fuller to drier.
void exchange_between(LoadedPatch& a, LoadedPatch& b, double share) {
  const double difference = a.water_ul / a.capacity_ul - b.water_ul / b.capacity_ul;
  LoadedPatch& from = difference > 0 ? a : b;
  LoadedPatch& to = difference > 0 ? b : a;
  if (from.water_ul <= 0 || std::abs(difference) < least_difference) return;
  const double flow = share * std::abs(difference) * std::min(a.capacity_ul, b.capacity_ul);
  hand_on(from, to, std::min(flow, from.water_ul));
}

// Every second pair of neighbours around, and then the others: so no side comes before another.
template <class Pass>
void for_each_pair_around(Loading& loading, Pass pass) {
  for (int i = 0; i < patches_along; ++i)
    for (const int first : {0, 1})
      for (int j = first; j < patches_around; j += 2)
        pass(i, loading.patches[patch_index(i, j)],
             loading.patches[patch_index(i, (j + 1) % patches_around)]);
}

// Between the sides of a row and its inside: one implicit step of C dp/dt = g (p' - p) for all of them, of
// such a length that the mean of the sides and the inside near each other exactly.
void flow_inward(Loading& loading, double per_s, double step_s) {
  const double eased = elementary::exponential(std::min(per_s * step_s, 50.0)) - 1;
  for (int i = 0; i < patches_along; ++i) {
    LoadedPatch& inside = loading.inside[static_cast<std::size_t>(i)];
    const double side_capacity = loading.patches[patch_index(i, 0)].capacity_ul;
    const double sides_capacity = side_capacity * patches_around;
    const double conductance = eased * inside.capacity_ul * sides_capacity /
                               ((inside.capacity_ul + sides_capacity) * patches_around);
    const double given = conductance / (side_capacity + conductance);
    double offered_ul = 0;
    for (int j = 0; j < patches_around; ++j) offered_ul += loading.patches[patch_index(i, j)].water_ul;
    const double fill =
        (inside.water_ul + given * offered_ul) / (inside.capacity_ul + given * sides_capacity);
    // Inwards first, so that the inside receives before it gives.
    for (const bool inwards : {true, false})
      for (int j = 0; j < patches_around; ++j) {
        LoadedPatch& side = loading.patches[patch_index(i, j)];
        const double flow = given * (side.water_ul - side_capacity * fill);
        if (std::abs(flow) < least_difference * side_capacity) continue;
        if (inwards && flow > 0) hand_on(side, inside, flow);
        if (!inwards && flow < 0) hand_on(inside, side, -flow);
      }
  }
}

// Pigment spreads around, inwards and along.
void spread(Loading& loading, const HairFlow& flow, double step_s) {
  PerRow around{};
  PerRow inward{};
  for (std::size_t i = 0; i < around.size(); ++i) {
    around[i] = evened(flow.around_per_s[i], step_s);
    inward[i] = evened(flow.inward_pigment_per_s[i], step_s);
  }
  for_each_pair_around(loading, [&](int row, LoadedPatch& a, LoadedPatch& b) {
    spread_pigment(a, b, around[static_cast<std::size_t>(row)]);
  });
  const double along = evened(flow.along_per_s, step_s);
  for (int i = 0; i < patches_along; ++i) {
    const auto row = static_cast<std::size_t>(i);
    for (int j = 0; j < patches_around; ++j)
      spread_pigment(loading.patches[patch_index(i, j)], loading.inside[row], inward[row]);
  }
  for (const int first : {0, 1})
    for (int i = first; i + 1 < patches_along; i += 2) {
      const auto row = static_cast<std::size_t>(i);
      for (int j = 0; j < patches_around; ++j)
        spread_pigment(loading.patches[patch_index(i, j)], loading.patches[patch_index(i + 1, j)], along);
      spread_pigment(loading.inside[row], loading.inside[row + 1], along);
    }
}

// Along the hair ink wicks as fast as the fullest part can feed it, however little the tip holds. One
// implicit step of C dp/dt = G p'' - D p for the fill p (Thomas' algorithm), so that it is stable at any G
// and D: `conductance` is G times the step and `demand_ul` D times the step, µl per unit of fill. Returns
// the fill.
template <class At>
PerRow wick(At at, double conductance, const PerRow& demand_ul) {
  PerRow fill{};
  PerRow ahead{};
  for (int i = 0; i < patches_along; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double before = i > 0 ? conductance : 0;
    const double after = i + 1 < patches_along ? conductance : 0;
    const double pivot =
        at(i).capacity_ul + demand_ul[k] + before + after - (i > 0 ? before * ahead[k - 1] : 0);
    ahead[k] = after / pivot;
    fill[k] = (at(i).water_ul + (i > 0 ? before * fill[k - 1] : 0)) / pivot;
  }
  for (std::size_t k = patches_along - 1; k-- > 0;) fill[k] += ahead[k] * fill[k + 1];

  // Down the tuft first and then up it, so that each patch receives before it gives.
  const auto flow = [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    return conductance * (fill[k] - fill[k + 1]);
  };
  for (int i = 0; i + 1 < patches_along; ++i)
    if (flow(i) > 0) hand_on(at(i), at(i + 1), flow(i));
  for (int i = patches_along - 2; i >= 0; --i)
    if (flow(i) < 0) hand_on(at(i + 1), at(i), -flow(i));
  return fill;
}

template <class Held>
InkLoad load_of(const Held& held, double full_ul) {
  if (held.water_ul <= 0) return {};
  InkLoad load{static_cast<float>(std::min(1.0, held.water_ul / full_ul)), {}};
  for (std::size_t c = 0; c < concentrations_per_group; ++c)
    load.strength[c] = static_cast<float>(std::max(0.0, held.pigment_ul[c]) / held.water_ul);
  return load;
}

// Takes `water_ul` out of the patch, and the pigment in it.
void withdraw(LoadedPatch& patch, double water_ul, PatchExchange& taken) {
  const double part = water_ul / patch.water_ul;
  patch.water_ul -= water_ul;
  taken.water_ul += water_ul;
  for (std::size_t c = 0; c < concentrations_per_group; ++c) {
    const double pigment = part * patch.pigment_ul[c];
    taken.pigment_ul[c] += pigment;
    patch.pigment_ul[c] -= pigment;
  }
}

constexpr int most_parts = 64;

// Sideways, in parts of the step in which no more than a quarter of a difference goes over.
void flow_across(Loading& loading, const HairFlow& flow, double step_s) {
  // One side and the other even out at the rate of the whole: that of the slowest wave around the ring.
  const double half_turn = elementary::sine(std::numbers::pi / patches_around);
  const double link_per_s = flow.moisture_per_s / (4 * half_turn * half_turn);
  const int parts = std::clamp(static_cast<int>(std::ceil(4 * link_per_s * step_s)), 1, most_parts);
  const double share = evened(link_per_s, step_s / parts);
  for (int k = 0; k < parts; ++k) {
    for_each_pair_around(loading,
                         [&](int, LoadedPatch& a, LoadedPatch& b) { exchange_between(a, b, share); });
    flow_inward(loading, flow.inward_per_s, step_s / parts);
  }
}

// Along the hair, and into the paper.
void flow_along(Loading& loading, const HairFlow& flow, double step_s, const PerPatch& demand_ul,
                Withdrawal& withdrawal) {
  double side_ul = 0;
  double inside_ul = 0;
  for (int i = 0; i < patches_along; ++i) {
    side_ul += loading.patches[patch_index(i, 0)].capacity_ul;
    inside_ul += loading.inside[static_cast<std::size_t>(i)].capacity_ul;
  }
  const double rate = step_s * flow.moisture_per_s;
  wick([&](int i) -> LoadedPatch& { return loading.inside[static_cast<std::size_t>(i)]; }, rate* inside_ul,
       {});
  for (int j = 0; j < patches_around; ++j) {
    PerRow demand{};
    for (int i = 0; i < patches_along; ++i)
      demand[static_cast<std::size_t>(i)] = demand_ul[patch_index(i, j)];
    const PerRow fill = wick([&](int i) -> LoadedPatch& { return loading.patches[patch_index(i, j)]; },
                             rate* side_ul, demand);
    for (int i = 0; i < patches_along; ++i) {
      const std::size_t k = patch_index(i, j);
      LoadedPatch& patch = loading.patches[k];
      const double wetness = std::min(1.0, fill[static_cast<std::size_t>(i)]);
      if (demand_ul[k] > 0 && wetness > 0 && patch.water_ul > 0)
        withdraw(patch, std::min(demand_ul[k] * wetness, patch.water_ul), withdrawal[k]);
    }
  }
}

// Moves ink in the tuft for one step.
void flow_freely(Loading& loading, const HairFlow& flow, double step_s, const PerPatch& demand_ul,
                 Withdrawal& withdrawal) {
  flow_across(loading, flow, step_s);
  loading.unspread_s += step_s;
  if (loading.unspread_s >= spread_part_s) {
    spread(loading, flow, loading.unspread_s);
    loading.unspread_s = 0;
  }
  flow_along(loading, flow, step_s, demand_ul, withdrawal);
}

}  // namespace

HairFlow flow_in(const Tuft& tuft) {
  HairFlow flow{.moisture_per_s = tuft.spec.moisture_flow_per_s, .inward_per_s = tuft.spec.inward_flow_per_s};
  const double row_mm = tuft.spec.tuft_length_mm / patches_along;
  flow.along_per_s = tuft.spec.pigment_spread_mm2_per_s / (row_mm * row_mm);
  for (std::size_t i = 0; i < patches_along; ++i) {
    const double radius = rest_radius_mm(tuft.spec, (static_cast<double>(i) + 0.5) / patches_along);
    const double arc = 2 * std::numbers::pi * radius / patches_around;
    flow.around_per_s[i] = tuft.spec.pigment_spread_mm2_per_s / (arc * arc);
    flow.inward_pigment_per_s[i] = tuft.spec.pigment_spread_mm2_per_s / (0.25 * radius * radius);
  }
  return flow;
}

Loading dry_loading(const Tuft& tuft) {
  Loading loading;
  std::array<double, patches_along> volume{};
  double total = 0;
  constexpr int slices = 8;
  for (int i = 0; i < patches_along * slices; ++i) {
    const double r = rest_radius_mm(tuft.spec, (i + 0.5) / (patches_along * slices));
    volume[static_cast<std::size_t>(i / slices)] += r * r;
    total += r * r;
  }
  for (int i = 0; i < patches_along; ++i) {
    const double row_ul = tuft.spec.capacity_ul * volume[static_cast<std::size_t>(i)] / total;
    loading.inside[static_cast<std::size_t>(i)].capacity_ul = inside_share * row_ul;
    for (int j = 0; j < patches_around; ++j)
      loading.patches[patch_index(i, j)].capacity_ul = (1 - inside_share) * row_ul / patches_around;
  }
  return loading;
}

void fill(Loading& loading, double wetness, const Concentrations& strength) {
  const double share = std::clamp(wetness, 0.0, 1.0);
  const auto soak = [&](LoadedPatch& part) {
    part.water_ul = share * part.capacity_ul;
    for (std::size_t c = 0; c < concentrations_per_group; ++c)
      part.pigment_ul[c] = part.water_ul * static_cast<double>(strength[c]);
  };
  std::ranges::for_each(loading.patches, soak);
  std::ranges::for_each(loading.inside, soak);
}

double wetness(const Loading& loading) {
  double water = 0;
  double capacity = 0;
  const auto add = [&](const LoadedPatch& part) {
    water += part.water_ul;
    capacity += part.capacity_ul;
  };
  std::ranges::for_each(loading.patches, add);
  std::ranges::for_each(loading.inside, add);
  return std::clamp(water / capacity, 0.0, 1.0);
}

std::vector<InkLoad> offered(const Loading& loading) {
  std::vector<InkLoad> loads(patch_count);
  for (std::size_t i = 0; i < loads.size(); ++i)
    loads[i] = load_of(loading.patches[i], loading.patches[i].capacity_ul);
  return loads;
}

std::vector<InkLoad> draw(Loading& loading, const HairFlow& flow, double step_s, const PerPatch& demand_ul) {
  Withdrawal withdrawal{};
  if (loading.endless) {
    loading.set_aside.push_back(withdrawal);
    return offered(loading);
  }
  const int parts =
      std::clamp(static_cast<int>(std::ceil(step_s / drawn_part_s - 1e-6)), 1, most_drawn_parts);
  PerPatch part_ul{};
  for (std::size_t k = 0; k < patch_count; ++k) part_ul[k] = demand_ul[k] / parts;
  for (int part = 0; part < parts; ++part) flow_freely(loading, flow, step_s / parts, part_ul, withdrawal);
  std::vector<InkLoad> loads = offered(loading);
  for (std::size_t k = 0; k < patch_count; ++k)
    if (demand_ul[k] > 0) loads[k] = load_of(withdrawal[k], demand_ul[k]);
  loading.set_aside.push_back(withdrawal);
  return loads;
}

void even_out(Loading& loading, const HairFlow& flow, double step_s) {
  if (loading.endless) return;
  Withdrawal none{};
  flow_freely(loading, flow, step_s, {}, none);
}

void book(Loading& loading, const Exchange& exchange) {
  if (exchange.patches.size() > patch_count)
    throw std::invalid_argument("an exchange with more patches than the tuft");
  Withdrawal booked{};
  if (!loading.set_aside.empty()) {
    booked = loading.set_aside.front();
    loading.set_aside.pop_front();
  }
  if (loading.endless) return;
  for (std::size_t i = 0; i < exchange.patches.size(); ++i) {
    booked[i].water_ul -= exchange.patches[i].water_ul;
    for (std::size_t c = 0; c < concentrations_per_group; ++c)
      booked[i].pigment_ul[c] -= exchange.patches[i].pigment_ul[c];
  }
  for (std::size_t i = 0; i < patch_count; ++i) {
    loading.patches[i].water_ul += booked[i].water_ul;
    for (std::size_t c = 0; c < concentrations_per_group; ++c)
      loading.patches[i].pigment_ul[c] += booked[i].pigment_ul[c];
  }
}

}  // namespace fude
