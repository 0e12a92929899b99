#include "sim/ink/cpu_ink.h"

#include <algorithm>

#include "sim/ink/kernels/lang_cpp.h"
#include "sim/ink/sheet_state.h"
#include "sim/ink/touched_cells.h"

namespace fude {
namespace {

// clang-format off
#include "sim/ink/kernels/numeric.k"
#include "sim/ink/kernels/site.k"
#include "sim/ink/kernels/deposit.k"
// clang-format on

Population population(const PlaneView& view, int x, int y) {
  const auto f = [&](std::size_t i) { return view.cells(i, y)[x]; };
  return {f(tile::rest), f(tile::e),  f(tile::n),  f(tile::w), f(tile::s),
          f(tile::ne),   f(tile::nw), f(tile::sw), f(tile::se)};
}

}  // namespace

CpuInk::CpuInk(const InkSetup& setup, InstructionSet set)
    : setup_(setup),
      columns_(cells_across(setup.width_mm, setup.cell_mm)),
      rows_(cells_across(setup.height_mm, setup.cell_mm)),
      numbers_(lattice_numbers(setup.paper, setup.cell_mm)),
      threads_(setup.threads) {
  const PaperTexture texture(setup.paper, setup.seed, setup.cell_mm, columns_, rows_, setup.flow);
  const LatticeSetup lattice{numbers_, texture, columns_, rows_, &step_kernels(set), &threads_};
  lattice_ = setup.dense ? make_dense_lattice(lattice) : make_tiled_lattice(lattice);
}

double CpuInk::ul_in_cell() const { return setup_.paper.capacity * setup_.cell_mm * setup_.cell_mm; }

void CpuInk::apply(const InkEvent& event) {
  Exchange exchange;
  if (const auto* what = std::get_if<Deposit>(&event.what))
    exchange = deposit(*what);
  else
    dry_sheet();
  exchange.event = event.id;
  ready_.push_back(std::move(exchange));
}

Exchange CpuInk::deposit(const Deposit& what) {
  Exchange exchange;
  exchange.patches.resize(what.patches.size());
  AwakeTile* tile = nullptr;
  for (const TouchedCell& cell : touched_cells(what, setup_.cell_mm, columns_, rows_)) {
    const TilePlace place{cell.row / tile::side, cell.column / tile::side};
    if (tile == nullptr || tile->place != place) tile = &lattice_->wake(place);
    const int x = cell.column % tile::side;
    const int y = cell.row % tile::side;
    const InkLoad& load = what.patches[cell.patch];
    float& surface = tile->view.cells(tile::still_begin + tile::surface, y)[x];
    std::array<float*, 4> mass;
    for (std::size_t c = 0; c < 4; ++c)
      mass[c] = &tile->view.cells(tile::still_begin + tile::surface_mass + c, y)[x];
    vec4 surface_mass{*mass[0], *mass[1], *mass[2], *mass[3]};
    float taken;
    vec4 taken_mass;
    touch(numbers_, total(population(tile->view, x, y)), load.wetness,
          {load.strength[0], load.strength[1], load.strength[2], load.strength[3]}, cell.fresh,
          cell.contact_s, surface, surface_mass, taken, taken_mass);
    *mass[0] = surface_mass.x;
    *mass[1] = surface_mass.y;
    *mass[2] = surface_mass.z;
    *mass[3] = surface_mass.w;
    tile->wet |= 1U << tile::own;
    PatchExchange& patch = exchange.patches[cell.patch];
    patch.water_ul += static_cast<double>(taken);
    const std::array<float, 4> pigment{taken_mass.x, taken_mass.y, taken_mass.z, taken_mass.w};
    for (std::size_t c = 0; c < 4; ++c) patch.pigment_ul[c] += static_cast<double>(pigment[c]);
  }
  for (PatchExchange& patch : exchange.patches) {
    water_deposited_ += patch.water_ul;
    patch.water_ul *= ul_in_cell();
    for (std::size_t c = 0; c < 4; ++c) {
      pigment_deposited_[c] += patch.pigment_ul[c];
      patch.pigment_ul[c] *= ul_in_cell();
    }
  }
  return exchange;
}

void CpuInk::dry_sheet() {
  water_evaporated_ += sum_layers(view_of(*lattice_)).water_left;
  for (AwakeTile& t : lattice_->awake()) {
    for (int y = 0; y < tile::side; ++y) {
      for (std::size_t c = 0; c < 4; ++c) {
        float* flow = t.view.cells(tile::mass + c, y);
        float* surface = t.view.cells(tile::still_begin + tile::surface_mass + c, y);
        float* fixed = t.view.cells(tile::still_begin + tile::fixed_mass + c, y);
        for (int x = 0; x < tile::side; ++x) fixed[x] += flow[x] + surface[x];
        std::fill_n(flow, tile::side, 0.0F);
        std::fill_n(surface, tile::side, 0.0F);
      }
      for (std::size_t f = tile::rest; f <= tile::se; ++f) std::fill_n(t.view.cells(f, y), tile::side, 0.0F);
      std::fill_n(t.view.cells(tile::still_begin + tile::surface, y), tile::side, 0.0F);
    }
    lay_fixed(t.view, fixed_of(t.view));
    t.wet = 0;
    t.changed = true;
  }
}

void CpuInk::step() {
  water_evaporated_ += lattice_->step(Stage::full);
  ++steps_;
}

std::vector<Exchange> CpuInk::collect() { return std::exchange(ready_, {}); }

InkTotals CpuInk::totals() const {
  InkTotals t = sum_layers(view_of(*lattice_));
  t.water_deposited = water_deposited_ * ul_in_cell();
  t.water_evaporated = water_evaporated_ * ul_in_cell();
  t.water_left *= ul_in_cell();
  for (std::size_t c = 0; c < concentrations_per_group; ++c) {
    t.pigment_deposited[c] = pigment_deposited_[c] * ul_in_cell();
    t.pigment_surface[c] *= ul_in_cell();
    t.pigment_flow[c] *= ul_in_cell();
    t.pigment_fixed[c] *= ul_in_cell();
  }
  return t;
}

CellRect CpuInk::active_rect() const {
  std::vector<TilePlace> places;
  for (const AwakeTile& t : lattice_->awake()) places.push_back(t.place);
  return rect_around(places, columns_, rows_);
}

std::size_t CpuInk::active_cells() const { return lattice_->awake().size() * tile::cells; }

bool CpuInk::still() const {
  return std::ranges::none_of(lattice_->awake(),
                              [](const AwakeTile& t) { return (t.wet >> tile::own & 1) != 0; });
}

InkRegion CpuInk::read(const CellRect& wanted) const {
  InkRegion region = blank_region(wanted, columns_, rows_);
  const auto per_area = static_cast<float>(setup_.paper.capacity);
  const std::vector<AwakeTile>& awake = lattice_->awake();
  threads_.for_each(awake.size(), [&](std::size_t i) { read_tile(awake[i], per_area, region); });
  for (const auto& [place, pigment] : lattice_->asleep())
    read_sleeping_tile(place, pigment, per_area, region);
  return region;
}

InkSnapshot CpuInk::snapshot(InkSnapshot memory) const {
  return {save_tiles(view_of(*lattice_), threads_, std::move(memory.tiles)),
          steps_,
          water_deposited_,
          water_evaporated_,
          pigment_deposited_,
          {},
          ready_};
}

void CpuInk::restore(const InkSnapshot& snapshot) {
  load_tiles(snapshot.tiles, *lattice_);
  steps_ = snapshot.steps;
  water_deposited_ = snapshot.water_deposited;
  water_evaporated_ = snapshot.water_evaporated;
  pigment_deposited_ = snapshot.pigment_deposited;
  ready_ = snapshot.ready;
  ready_.insert(ready_.end(), snapshot.pending.begin(), snapshot.pending.end());
}

std::uint64_t CpuInk::hash() const { return hash_tiles(save_tiles(view_of(*lattice_), threads_)); }

}  // namespace fude
