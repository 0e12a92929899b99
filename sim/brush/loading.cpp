#include "sim/brush/loading.h"

#include <algorithm>
#include <stdexcept>

#include "signal/elementary.h"

namespace fude {
namespace {

std::size_t patch_index(int along, int around) {
  return static_cast<std::size_t>(along * patches_around + around);
}

// Moves the share of the difference in fill that one link passes, from fuller to drier.
void exchange_between(LoadedPatch& a, LoadedPatch& b, double share) {
  const double fill_a = a.water_ul / a.capacity_ul;
  const double fill_b = b.water_ul / b.capacity_ul;
  LoadedPatch& from = fill_a > fill_b ? a : b;
  LoadedPatch& to = fill_a > fill_b ? b : a;
  if (from.water_ul <= 0) return;
  const double difference = fill_a > fill_b ? fill_a - fill_b : fill_b - fill_a;
  const double flow = std::min(share * difference * std::min(a.capacity_ul, b.capacity_ul), from.water_ul);
  const double part = flow / from.water_ul;
  from.water_ul -= flow;
  to.water_ul += flow;
  for (std::size_t c = 0; c < concentrations_per_group; ++c) {
    const double carried = part * from.pigment_ul[c];
    from.pigment_ul[c] -= carried;
    to.pigment_ul[c] += carried;
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

// Along the hair ink wicks as fast as the fullest part can feed it, however little the tip holds. One
// implicit step of C dp/dt = G p'' - D p for the fill p (Thomas' algorithm), so that it is stable at any G
// and D: `conductance` is G times the step and `demand_ul` D times the step, µl per unit of fill. Returns
// the fill.
std::array<double, patches_along> wick(Loading& loading, int around, double conductance,
                                       const PerPatch& demand_ul) {
  std::array<double, patches_along> fill{};
  std::array<double, patches_along> ahead{};
  const auto at = [&](int i) -> LoadedPatch& { return loading.patches[patch_index(i, around)]; };
  for (int i = 0; i < patches_along; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double before = i > 0 ? conductance : 0;
    const double after = i + 1 < patches_along ? conductance : 0;
    const double pivot = at(i).capacity_ul + demand_ul[patch_index(i, around)] + before + after -
                         (i > 0 ? before * ahead[k - 1] : 0);
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

Concentrations strength_of(const LoadedPatch& patch) {
  Concentrations strength{};
  for (std::size_t c = 0; c < concentrations_per_group; ++c)
    strength[c] = static_cast<float>(std::max(0.0, patch.pigment_ul[c]) / patch.water_ul);
  return strength;
}

// Takes `water_ul` out of the patch, and the pigment in it.
PatchExchange withdrawn(LoadedPatch& patch, double water_ul) {
  PatchExchange taken{water_ul, {}};
  const double part = water_ul / patch.water_ul;
  patch.water_ul -= water_ul;
  for (std::size_t c = 0; c < concentrations_per_group; ++c) {
    taken.pigment_ul[c] = part * patch.pigment_ul[c];
    patch.pigment_ul[c] -= taken.pigment_ul[c];
  }
  return taken;
}

// Moves ink in the tuft for one step while the paper draws on it: what each patch offers, and what leaves.
std::vector<InkLoad> flow(Loading& loading, double rate_per_s, double step_s, const PerPatch& demand_ul,
                          Withdrawal& withdrawal) {
  // Around, from neighbour to neighbour: a quarter of the difference at most, or they would swap.
  const double share = 0.25 * (1 - elementary::exponential(-4 * rate_per_s * step_s));
  for (int i = 0; i < patches_along; ++i)
    for (int j = 0; j < patches_around; ++j)
      exchange_between(loading.patches[patch_index(i, j)],
                       loading.patches[patch_index(i, (j + 1) % patches_around)], share);
  double capacity = 0;
  for (const LoadedPatch& patch : loading.patches) capacity += patch.capacity_ul;
  const double conductance = step_s * rate_per_s * capacity / patches_around;
  std::vector<InkLoad> loads(patch_count);
  for (int j = 0; j < patches_around; ++j) {
    const auto fill = wick(loading, j, conductance, demand_ul);
    for (int i = 0; i < patches_along; ++i) {
      const std::size_t k = patch_index(i, j);
      LoadedPatch& patch = loading.patches[k];
      const double wetness = std::min(1.0, fill[static_cast<std::size_t>(i)]);
      if (wetness <= 0 || patch.water_ul <= 0) continue;
      loads[k] = {static_cast<float>(wetness), strength_of(patch)};
      if (demand_ul[k] > 0)
        withdrawal[k] = withdrawn(patch, std::min(demand_ul[k] * wetness, patch.water_ul));
    }
  }
  return loads;
}

}  // namespace

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
  for (int i = 0; i < patches_along; ++i)
    for (int j = 0; j < patches_around; ++j)
      loading.patches[patch_index(i, j)].capacity_ul =
          tuft.spec.capacity_ul * volume[static_cast<std::size_t>(i)] / (total * patches_around);
  return loading;
}

void fill(Loading& loading, double wetness, const Concentrations& strength) {
  const double share = std::clamp(wetness, 0.0, 1.0);
  for (LoadedPatch& patch : loading.patches) {
    patch.water_ul = share * patch.capacity_ul;
    for (std::size_t c = 0; c < concentrations_per_group; ++c)
      patch.pigment_ul[c] = patch.water_ul * strength[c];
  }
}

double wetness(const Loading& loading) {
  double water = 0;
  double capacity = 0;
  for (const LoadedPatch& patch : loading.patches) {
    water += patch.water_ul;
    capacity += patch.capacity_ul;
  }
  return std::clamp(water / capacity, 0.0, 1.0);
}

std::vector<InkLoad> offered(const Loading& loading) {
  std::vector<InkLoad> loads(patch_count);
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const LoadedPatch& patch = loading.patches[i];
    if (patch.water_ul <= 0) continue;
    loads[i] = {static_cast<float>(std::min(1.0, patch.water_ul / patch.capacity_ul)), strength_of(patch)};
  }
  return loads;
}

std::vector<InkLoad> draw(Loading& loading, double rate_per_s, double step_s, const PerPatch& demand_ul) {
  Withdrawal withdrawal{};
  std::vector<InkLoad> loads =
      flow(loading, rate_per_s, step_s, loading.endless ? PerPatch{} : demand_ul, withdrawal);
  loading.set_aside.push_back(withdrawal);
  return loads;
}

void even_out(Loading& loading, double rate_per_s, double step_s) {
  Withdrawal none{};
  flow(loading, rate_per_s, step_s, {}, none);
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
