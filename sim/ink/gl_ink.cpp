#include "sim/ink/gl_ink.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <utility>

#include "sim/compute/gl_context.h"
#include "sim/ink/gl_tiles.h"
#include "sim/ink/sheet_state.h"
#include "sim/ink/touched_cells.h"

namespace fude {
namespace {

// As gl_deposit.comp has them.
struct CellTouches {
  std::int32_t slot;
  std::int32_t cell;
  std::int32_t first;
  std::int32_t touches;
};
struct Touch {
  Concentrations strength;
  float wetness;
  float fresh;
  float contact_s;
  float unused;
};
struct Taken {
  Concentrations mass;
  float water;
  float unused[3];
};

// What an event's exchange is made of, once it is here.
struct Answer {
  Exchange exchange;
  std::vector<std::uint16_t> patches;  // of the touches
  std::optional<GlReadBack> taken;     // none: the exchange is complete
};

template <class T>
T require(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

template <class T>
GlBuffer uploaded(const std::vector<T>& values) {
  GlBuffer buffer = require(GlBuffer::make(values.size() * sizeof(T)));
  buffer.write(0, bytes_of(values));
  return buffer;
}

class GlInk final : public Ink {
 public:
  GlInk(const InkSetup& setup, GlContext context, GlInkPrograms programs, GlTiles tiles)
      : setup_(setup),
        columns_(cells_across(setup.width_mm, setup.cell_mm)),
        rows_(cells_across(setup.height_mm, setup.cell_mm)),
        context_(std::move(context)),
        state_(std::make_unique<State>(State{std::move(programs), std::move(tiles), {}, {}, 0, {}})) {}

  ~GlInk() override {
    const GlContext::Use use(context_);
    state_.reset();
  }

  int columns() const override { return columns_; }
  int rows() const override { return rows_; }
  double cell_mm() const override { return setup_.cell_mm; }
  double step_s() const override { return step_seconds(setup_.cell_mm); }
  std::uint64_t steps() const override { return steps_; }
  std::size_t active_cells() const override { return state_->tiles.places().size() * tile::cells; }
  CellRect active_rect() const override { return rect_around(state_->tiles.places(), columns_, rows_); }

  void apply(const InkEvent& event) override {
    const GlContext::Use use(context_);
    Answer answer;
    if (const auto* what = std::get_if<Deposit>(&event.what))
      answer = deposit(*what);
    else
      dry_sheet();
    answer.exchange.event = event.id;
    state_->pending.push_back(std::move(answer));
  }

  void step() override {
    const GlContext::Use use(context_);
    state_->tiles.step(state_->programs);
    ++steps_;
    std::ranges::move(state_->pending, std::back_inserter(state_->ready));
    state_->pending.clear();
  }

  std::vector<Exchange> collect() override {
    const GlContext::Use use(context_);
    std::vector<Exchange> exchanges = complete(state_->ready);
    state_->ready.clear();
    return exchanges;
  }

  InkTotals totals() const override {
    const GlContext::Use use(context_);
    complete(state_->pending);
    complete(state_->ready);
    InkTotals t = sum_layers(view_of(whole_sheet()));
    t.water_deposited = state_->water_deposited * ul_in_cell();
    t.water_evaporated = evaporated() * ul_in_cell();
    t.water_left *= ul_in_cell();
    for (std::size_t c = 0; c < concentrations_per_group; ++c) {
      t.pigment_deposited[c] = state_->pigment_deposited[c] * ul_in_cell();
      t.pigment_surface[c] *= ul_in_cell();
      t.pigment_flow[c] *= ul_in_cell();
      t.pigment_fixed[c] *= ul_in_cell();
    }
    return t;
  }

  bool still() const override {
    const GlContext::Use use(context_);
    return state_->tiles.still();
  }

  InkRegion read(const CellRect& wanted) const override {
    const GlContext::Use use(context_);
    InkRegion region = blank_region(wanted, columns_, rows_);
    const auto per_area = static_cast<float>(setup_.paper.capacity);
    const TileCopies copies = state_->tiles.copies(region.rect);
    for (const AwakeTile& t : copies.tiles) read_tile(t, per_area, region);
    for (const auto& [place, pigment] : state_->tiles.asleep())
      read_sleeping_tile(place, pigment, per_area, region);
    return region;
  }

  InkSnapshot snapshot(InkSnapshot memory) const override {
    const GlContext::Use use(context_);
    InkSnapshot snapshot;
    snapshot.tiles = save_tiles(view_of(whole_sheet()), one_thread_, std::move(memory.tiles));
    snapshot.steps = steps_;
    snapshot.pending = complete(state_->pending);
    snapshot.ready = complete(state_->ready);
    snapshot.water_deposited = state_->water_deposited;
    snapshot.water_evaporated = evaporated();
    snapshot.pigment_deposited = state_->pigment_deposited;
    return snapshot;
  }

  void restore(const InkSnapshot& snapshot) override {
    const GlContext::Use use(context_);
    state_->tiles.clear();
    for (const InkSnapshot::Tile& saved : snapshot.tiles) state_->tiles.load(saved);
    steps_ = snapshot.steps;
    evaporated_elsewhere_ = snapshot.water_evaporated - state_->tiles.evaporated();
    state_->water_deposited = snapshot.water_deposited;
    state_->pigment_deposited = snapshot.pigment_deposited;
    state_->pending.clear();
    state_->ready.clear();
    for (const Exchange& exchange : snapshot.pending) state_->pending.push_back({exchange, {}, {}});
    for (const Exchange& exchange : snapshot.ready) state_->ready.push_back({exchange, {}, {}});
  }

  std::uint64_t hash() const override {
    const GlContext::Use use(context_);
    return hash_tiles(save_tiles(view_of(whole_sheet()), one_thread_));
  }

 private:
  // All that lives on the card or is on its way here; a reading may complete it.
  struct State {
    GlInkPrograms programs;
    GlTiles tiles;
    std::vector<Answer> pending;
    std::vector<Answer> ready;
    double water_deposited;  // in saturated cells
    InkTotals::Pigments pigment_deposited;
  };

  double ul_in_cell() const { return setup_.paper.capacity * setup_.cell_mm * setup_.cell_mm; }

  double evaporated() const { return evaporated_elsewhere_ + state_->tiles.evaporated(); }

  TileCopies whole_sheet() const { return state_->tiles.copies({0, 0, columns_, rows_}); }

  SheetView view_of(const TileCopies& copies) const { return {copies.tiles, state_->tiles.asleep()}; }

  Answer deposit(const Deposit& what) {
    Answer answer;
    answer.exchange.patches.resize(what.patches.size());
    std::vector<CellTouches> cells;
    std::vector<Touch> touches;
    std::optional<TilePlace> poured;
    std::int32_t slot = 0;
    for (const TouchedCell& cell : touched_cells(what, setup_.cell_mm, columns_, rows_)) {
      const TilePlace place{cell.row / tile::side, cell.column / tile::side};
      if (poured != place) slot = state_->tiles.pour(place);
      poured = place;
      const std::int32_t index = cell.row % tile::side * tile::side + cell.column % tile::side;
      const auto next = static_cast<std::int32_t>(touches.size());
      if (cells.empty() || cells.back().slot != slot || cells.back().cell != index)
        cells.push_back({slot, index, next, 0});
      ++cells.back().touches;
      const InkLoad& load = what.patches[cell.patch];
      touches.push_back({load.strength, load.wetness, cell.fresh, cell.contact_s, 0});
      answer.patches.push_back(cell.patch);
    }
    if (touches.empty()) return answer;

    const GlBuffer cell_buffer = uploaded(cells);
    const GlBuffer touch_buffer = uploaded(touches);
    const GlBuffer taken = require(GlBuffer::make(touches.size() * sizeof(Taken)));
    state_->tiles.bind_for_deposit();
    cell_buffer.bind_storage(1);
    touch_buffer.bind_storage(2);
    taken.bind_storage(3);
    state_->programs.deposit.set("count", static_cast<int>(cells.size()));
    state_->programs.deposit.run(static_cast<std::uint32_t>((cells.size() + 63) / 64));
    answer.taken = require(GlReadBack::begin(taken, 0, taken.bytes()));
    return answer;
  }

  // Waits for what is still on its way.
  std::vector<Exchange> complete(std::vector<Answer>& answers) const {
    std::vector<Exchange> exchanges;
    for (Answer& answer : answers) {
      if (answer.taken) complete(answer);
      exchanges.push_back(answer.exchange);
    }
    return exchanges;
  }

  void complete(Answer& answer) const {
    const std::vector<std::byte> bytes = answer.taken->collect();
    for (std::size_t i = 0; i < answer.patches.size(); ++i) {
      Taken taken;
      std::memcpy(&taken, bytes.data() + i * sizeof taken, sizeof taken);
      PatchExchange& patch = answer.exchange.patches[answer.patches[i]];
      patch.water_ul += static_cast<double>(taken.water);
      for (std::size_t c = 0; c < taken.mass.size(); ++c)
        patch.pigment_ul[c] += static_cast<double>(taken.mass[c]);
    }
    for (PatchExchange& patch : answer.exchange.patches) {
      state_->water_deposited += patch.water_ul;
      patch.water_ul *= ul_in_cell();
      for (std::size_t c = 0; c < patch.pigment_ul.size(); ++c) {
        state_->pigment_deposited[c] += patch.pigment_ul[c];
        patch.pigment_ul[c] *= ul_in_cell();
      }
    }
    answer.taken.reset();
  }

  // Rare: every layer of the sheet comes here, is fixed, and goes back asleep.
  void dry_sheet() {
    const TileCopies copies = whole_sheet();
    evaporated_elsewhere_ += sum_layers(view_of(copies)).water_left;
    std::vector<InkSnapshot::Tile> tiles = save_tiles(view_of(copies), one_thread_);
    for (InkSnapshot::Tile& t : tiles) dry(t);
    state_->tiles.clear();
    for (const InkSnapshot::Tile& t : tiles) state_->tiles.load(t);
  }

  InkSetup setup_;
  int columns_;
  int rows_;
  mutable ThreadPool one_thread_{1};  // the card has the others
  GlContext context_;
  std::unique_ptr<State> state_;
  std::uint64_t steps_ = 0;
  double evaporated_elsewhere_ = 0;  // before a restored snapshot, or dried at once
};

}  // namespace

Result<std::unique_ptr<Ink>> open_gl_ink(const InkSetup& setup) {
  auto context = GlContext::open(GlContext::Renderer::any);
  if (!context) return tl::unexpected(context.error());
  auto programs = GlInkPrograms::compile();
  if (!programs) return tl::unexpected(programs.error());
  const int columns = cells_across(setup.width_mm, setup.cell_mm);
  const int rows = cells_across(setup.height_mm, setup.cell_mm);
  const PaperTexture texture(setup.paper, setup.seed, setup.cell_mm, columns, rows, setup.flow);
  auto tiles = GlTiles::make(lattice_numbers(setup.paper, setup.cell_mm), texture, columns, rows);
  if (!tiles) return tl::unexpected(tiles.error());
  context->release();
  return std::make_unique<GlInk>(setup, std::move(*context), std::move(*programs), std::move(*tiles));
}

bool graphics_card_exists() {
  auto context = GlContext::open(GlContext::Renderer::hardware_only);
  return context.has_value();
}

}  // namespace fude
