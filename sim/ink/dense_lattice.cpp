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
        row_(width_ + 2 * margin),
        plane_(static_cast<std::ptrdiff_t>(row_) * (height_ + 2) + margin),
        arena_(tile::planes * static_cast<std::size_t>(plane_), 1),
        memory_(arena_.take()),
        outcomes_(static_cast<std::size_t>(width_ / dense_width) *
                  static_cast<std::size_t>(height_ / tile::side)) {
    for (int y = -1; y <= height_; ++y) {
      std::fill_n(at(tile::paper_begin + tile::blocking, -margin, y), row_, tile::closed_blocking);
      std::fill_n(at(tile::paper_begin + tile::grain, -margin, y), row_, tile::closed_grain);
    }
    for (int row = 0; row < tiles_across(setup.rows); ++row)
      for (int column = 0; column < tiles_across(setup.columns); ++column) {
        const PlaneView view{at(0, column * tile::side, row * tile::side), row_, plane_};
        setup_.texture.fill(column * tile::side, row * tile::side, view);
        awake_.push_back({{row, column}, view, 0});
      }
  }

  std::vector<AwakeTile>& awake() override { return awake_; }
  const std::map<TilePlace, FixedPigment>& asleep() const override { return asleep_; }
  int parity() const override { return parity_; }

  AwakeTile& wake(TilePlace place) override {
    return *std::ranges::lower_bound(awake_, place, {}, &AwakeTile::place);
  }

  double step(Stage stage) override {
    const auto kernel = stage == Stage::full ? setup_.kernels->dense : setup_.kernels->dense_water;
    const int across = width_ / dense_width;
    setup_.threads->for_each(outcomes_.size(), [&](std::size_t i) {
      const int block = static_cast<int>(i);
      const PlaneView view{at(0, block % across * dense_width, block / across * tile::side), row_, plane_};
      kernel(setup_.numbers, view, parity_, outcomes_[i]);
    });
    parity_ = 1 - parity_;
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
    for (std::size_t plane = 0; plane < tile::paper_begin; ++plane)
      for (int y = 0; y < height_; ++y) std::fill_n(at(plane, 0, y), width_, 0.0F);
    for (AwakeTile& t : awake_) t.wet = 0;
  }

  void lay(TilePlace place, const FixedPigment& pigment) override {
    lay_fixed(wake(place).view, parity_, pigment);
  }

 private:
  static constexpr int margin = 16;

  float* at(std::size_t plane, int x, int y) {
    return memory_ + static_cast<std::ptrdiff_t>(plane) * plane_ +
           static_cast<std::ptrdiff_t>(row_) * (y + 1) + margin + x;
  }

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
  int parity_ = 0;
};

}  // namespace

std::unique_ptr<Lattice> make_dense_lattice(const LatticeSetup& setup) {
  return std::make_unique<DenseLattice>(setup);
}

}  // namespace fude
