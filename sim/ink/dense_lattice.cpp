#include <algorithm>

#include "sim/compute/arena.h"
#include "sim/ink/lattice.h"

namespace fude {
namespace {

int rounded_up(int x, int to) { return (x + to - 1) / to * to; }

// Every plane over the whole sheet, with a margin of closed cells; every tile is always awake.
class DenseLattice final : public Lattice {
 public:
  explicit DenseLattice(const LatticeSetup& setup)
      : setup_(setup),
        width_(rounded_up(setup.columns, dense_width)),
        height_(rounded_up(setup.rows, tile::side)),
        row_(width_ + 2 * dense_margin),
        plane_(static_cast<std::ptrdiff_t>(row_) * (height_ + 2) + dense_margin),
        arena_((tile::planes + tile::flowing_planes) * static_cast<std::size_t>(plane_), 1),
        memory_(arena_.take()),
        outcomes_(static_cast<std::size_t>(width_ / dense_width) *
                  static_cast<std::size_t>(height_ / tile::side)) {
    for (int y = -1; y <= height_; ++y) {
      std::fill_n(at(tile::paper_begin + tile::blocking, -dense_margin, y), row_, tile::closed_blocking);
      std::fill_n(at(tile::paper_begin + tile::grain, -dense_margin, y), row_, tile::closed_grain);
    }
    for (int row = 0; row < tiles_across(setup.rows); ++row)
      for (int column = 0; column < tiles_across(setup.columns); ++column) {
        const PlaneView view = seen(column * tile::side, row * tile::side, parity_);
        setup_.texture.fill(column * tile::side, row * tile::side, view);
        awake_.push_back({{row, column}, view});
      }
  }

  std::vector<AwakeTile>& awake() override { return awake_; }
  const std::map<TilePlace, FixedPigment>& asleep() const override { return asleep_; }

  AwakeTile& wake(TilePlace place) override {
    return *std::ranges::lower_bound(awake_, place, {}, &AwakeTile::place);
  }

  double step(Stage stage) override {
    const StageKernels& kernels = stage == Stage::full ? setup_.kernels->full : setup_.kernels->water;
    const int across = width_ / dense_width;
    setup_.threads->for_each(outcomes_.size(), [&](std::size_t i) {
      const int block = static_cast<int>(i);
      const int x = block % across * dense_width;
      const int y = block / across * tile::side;
      kernels.dense(setup_.numbers, seen(x, y, parity_), seen(x, y, 1 - parity_), outcomes_[i]);
    });
    parity_ = 1 - parity_;
    for (AwakeTile& t : awake_) t.view = seen(t.place.column * tile::side, t.place.row * tile::side, parity_);
    double evaporated = 0;
    for (const TileOutcome& outcome : outcomes_) evaporated += outcome.evaporated;
    // A block is wider than a tile: its tiles count as wet together.
    for (AwakeTile& t : awake_) {
      const int block = t.place.row * across + t.place.column * tile::side / dense_width;
      if (stage == Stage::full) t.wet = outcomes_[static_cast<std::size_t>(block)].wet;
    }
    return evaporated;
  }

  void clear() override {
    for (std::size_t plane = 0; plane < tile::planes + tile::flowing_planes; ++plane)
      for (int y = 0; y < height_ && !is_paper(plane); ++y) std::fill_n(at(plane, 0, y), width_, 0.0F);
    for (AwakeTile& t : awake_) t.wet = 0;
  }

  void lay(TilePlace place, const FixedPigment& pigment) override { lay_fixed(wake(place).view, pigment); }

 private:
  float* at(std::size_t plane, int x, int y) {
    return memory_ + static_cast<std::ptrdiff_t>(plane) * plane_ +
           static_cast<std::ptrdiff_t>(row_) * (y + 1) + dense_margin + x;
  }

  // The second flowing planes come after all others.
  PlaneView seen(int x, int y, int parity) {
    return {at(parity == 0 ? 0 : std::size_t{tile::planes}, x, y), at(tile::still_begin, x, y), row_, plane_};
  }

  static bool is_paper(std::size_t plane) { return plane >= tile::paper_begin && plane < tile::planes; }

  LatticeSetup setup_;
  int width_;
  int height_;
  std::ptrdiff_t row_;
  std::ptrdiff_t plane_;
  Arena arena_;
  float* memory_;
  std::vector<TileOutcome> outcomes_;
  std::vector<AwakeTile> awake_;
  std::map<TilePlace, FixedPigment> asleep_;
  int parity_ = 0;  // which flowing planes hold the state
};

}  // namespace

std::unique_ptr<Lattice> make_dense_lattice(const LatticeSetup& setup) {
  return std::make_unique<DenseLattice>(setup);
}

}  // namespace fude
