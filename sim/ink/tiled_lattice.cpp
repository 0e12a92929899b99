#include <algorithm>
#include <optional>

#include "sim/compute/arena.h"
#include "sim/ink/lattice.h"

namespace fude {
namespace {

// Tiles that are no longer needed are looked for this often: waking one costs its textures.
constexpr int steps_between_sweeps = 32;

class TiledLattice final : public Lattice {
 public:
  explicit TiledLattice(const LatticeSetup& setup)
      : setup_(setup),
        tile_columns_(tiles_across(setup.columns)),
        tile_rows_(tiles_across(setup.rows)),
        blocks_(static_cast<std::size_t>(tile_columns_) * static_cast<std::size_t>(tile_rows_), nullptr),
        arena_(tile::block_floats, tile::chunk_tiles),
        outside_(arena_.take()) {
    const PlaneView outside = arena_view(outside_);
    for (int y = 0; y < tile::side; ++y) {
      std::fill_n(outside.cells(tile::paper_begin + tile::blocking, y), tile::side, tile::closed_blocking);
      std::fill_n(outside.cells(tile::paper_begin + tile::grain, y), tile::side, tile::closed_grain);
    }
  }

  std::vector<AwakeTile>& awake() override { return awake_; }
  const std::map<TilePlace, FixedPigment>& asleep() const override { return asleep_; }

  AwakeTile& wake(TilePlace place) override {
    const auto at = std::ranges::lower_bound(awake_, place, {}, &AwakeTile::place);
    if (at != awake_.end() && at->place == place) return *at;
    neighbours_known_ = false;
    return *awake_.insert(at, woken(place));
  }

  double step(Stage stage) override {
    wake_where_water_comes();
    if (++steps_ % steps_between_sweeps == 0) sleep_where_none_can_come();
    if (!neighbours_known_) know_neighbours();
    const StageKernels& kernels = stage == Stage::full ? setup_.kernels->full : setup_.kernels->water;
    make_edges(stage, kernels);
    setup_.threads->for_each(awake_.size(), [&](std::size_t i) {
      const Neighbourhood& next = neighbours_[i + 1 < awake_.size() ? i + 1 : i];
      kernels.tile(setup_.numbers, neighbours_[i], next, parity_, outcomes_[i]);
    });
    parity_ = 1 - parity_;
    double evaporated = 0;
    for (std::size_t i = 0; stage == Stage::full && i < awake_.size(); ++i) {
      evaporated += outcomes_[i].evaporated;
      awake_[i].wet = outcomes_[i].wet;
    }
    return evaporated;
  }

  void clear() override {
    for (const AwakeTile& t : awake_) give_back(t);
    awake_.clear();
    asleep_.clear();
    neighbours_known_ = false;
  }

  void lay(TilePlace place, const FixedPigment& pigment) override { asleep_[place] = pigment; }

 private:
  bool on_sheet(TilePlace p) const {
    return p.row >= 0 && p.column >= 0 && p.row < tile_rows_ && p.column < tile_columns_;
  }

  float*& block(TilePlace p) {
    return blocks_[static_cast<std::size_t>(p.row) * static_cast<std::size_t>(tile_columns_) +
                   static_cast<std::size_t>(p.column)];
  }

  AwakeTile woken(TilePlace place) {
    float* memory = arena_.take();
    block(place) = memory;
    const PlaneView view = arena_view(memory);
    std::fill_n(memory, tile::block_floats, 0.0F);
    setup_.texture.fill(place.column * tile::side, place.row * tile::side, view);
    if (const auto kept = asleep_.find(place); kept != asleep_.end()) {
      lay_fixed(view, kept->second);
      asleep_.erase(kept);
    }
    return {place, view};
  }

  // The edges of tiles that others have changed; of all tiles where the last step was of another stage.
  void make_edges(Stage stage, const StageKernels& kernels) {
    if (stage != edges_of_) {
      for (AwakeTile& t : awake_) t.changed = true;
      for (int parity : {0, 1}) kernels.edges(setup_.numbers, outside_, parity);
      edges_of_ = stage;
    }
    for (AwakeTile& t : awake_) {
      if (t.changed) kernels.edges(setup_.numbers, t.view.flowing, parity_);
      t.changed = false;
    }
  }

  // A wet edge may spill into the tile beside it in the next step, so that tile must be awake by then.
  void wake_where_water_comes() {
    std::vector<AwakeTile> fresh;
    for (const AwakeTile& t : awake_)
      for (std::size_t i = 0; i < tile::neighbourhood; ++i) {
        const TilePlace p = beside(t.place, i);
        if ((t.wet >> i & 1) != 0 && on_sheet(p) && block(p) == nullptr) fresh.push_back(woken(p));
      }
    if (fresh.empty()) return;
    awake_.insert(awake_.end(), fresh.begin(), fresh.end());
    std::ranges::sort(awake_, {}, &AwakeTile::place);
    neighbours_known_ = false;
  }

  // A dry tile may sleep only when no neighbour's edge beside it is wet.
  void sleep_where_none_can_come() {
    std::vector<bool> needed(awake_.size(), false);
    for (const AwakeTile& t : awake_)
      for (std::size_t i = 0; i < tile::neighbourhood; ++i)
        if ((t.wet >> i & 1) != 0) {
          const auto at = std::ranges::lower_bound(awake_, beside(t.place, i), {}, &AwakeTile::place);
          if (at != awake_.end() && at->place == beside(t.place, i))
            needed[static_cast<std::size_t>(at - awake_.begin())] = true;
        }
    std::vector<AwakeTile> kept;
    for (std::size_t i = 0; i < awake_.size(); ++i) {
      if (needed[i]) {
        kept.push_back(awake_[i]);
        continue;
      }
      keep_fixed(awake_[i]);
      give_back(awake_[i]);
    }
    if (kept.size() == awake_.size()) return;
    awake_ = std::move(kept);
    neighbours_known_ = false;
  }

  void keep_fixed(const AwakeTile& t) {
    FixedPigment pigment = fixed_of(t.view);
    if (std::ranges::any_of(pigment, [](float m) { return m != 0; })) asleep_[t.place] = std::move(pigment);
  }

  void give_back(const AwakeTile& t) {
    arena_.give_back(t.view.flowing);
    block(t.place) = nullptr;
  }

  static TilePlace beside(TilePlace p, std::size_t i) {
    return {p.row + static_cast<int>(i / 3) - 1, p.column + static_cast<int>(i % 3) - 1};
  }

  void know_neighbours() {
    outcomes_.resize(awake_.size());
    neighbours_.resize(awake_.size());
    for (std::size_t t = 0; t < awake_.size(); ++t)
      for (std::size_t i = 0; i < tile::neighbourhood; ++i) {
        const TilePlace p = beside(awake_[t].place, i);
        float* memory = on_sheet(p) ? block(p) : nullptr;
        neighbours_[t][i] = memory == nullptr ? outside_ : memory;
      }
    neighbours_known_ = true;
  }

  LatticeSetup setup_;
  int tile_columns_;
  int tile_rows_;
  std::vector<float*> blocks_;  // of every tile of the sheet; null where it sleeps
  Arena arena_;
  float* outside_;  // stands for what is off the sheet or asleep: dry and closed
  std::vector<AwakeTile> awake_;
  std::vector<TileOutcome> outcomes_;
  std::vector<Neighbourhood> neighbours_;
  std::map<TilePlace, FixedPigment> asleep_;
  bool neighbours_known_ = false;
  int parity_ = 0;  // of the edges that the next step reads
  std::optional<Stage> edges_of_;
  int steps_ = 0;
};

}  // namespace

std::unique_ptr<Lattice> make_tiled_lattice(const LatticeSetup& setup) {
  return std::make_unique<TiledLattice>(setup);
}

}  // namespace fude
