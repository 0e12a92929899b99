// Where the state of the sheet lies and how it is stepped: in tiles that wake and sleep with the water, or
// dense, which is simpler and the reference for tests.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <vector>

#include "sim/compute/thread_pool.h"
#include "sim/ink/lattice_numbers.h"
#include "sim/ink/paper_texture.h"
#include "sim/ink/tile_step.h"

namespace fude {

// A tile by its place: column and row of the grid of tiles, ordered by row, then column.
struct TilePlace {
  int row = 0;
  int column = 0;
  auto operator<=>(const TilePlace&) const = default;
};

struct AwakeTile {
  TilePlace place;
  PlaneView view;
  std::uint16_t wet = 0;  // as TileOutcome::wet; bit 4 set by whoever pours water on it
  bool changed = true;  // in its flowing or fixed planes since the last step, by other hands than the step's
};

// Pigment that a sleeping tile keeps: its four fixed planes, plane by plane.
using FixedPigment = std::vector<float>;

FixedPigment fixed_of(const PlaneView& tile);
void lay_fixed(const PlaneView& tile, const FixedPigment& pigment);

enum class Stage { full, water };  // all of the ink; stream, block and collide alone

class Lattice {
 public:
  virtual ~Lattice() = default;

  // In ascending order of place. Views end at step().
  virtual std::vector<AwakeTile>& awake() = 0;
  virtual const std::map<TilePlace, FixedPigment>& asleep() const = 0;

  // Wakes a tile of the sheet; nothing where it is awake. References into awake() end here and at step().
  virtual AwakeTile& wake(TilePlace place) = 0;

  // One step of every awake tile; returns the water that evaporated, in saturated cells.
  virtual double step(Stage stage) = 0;

  // Back to a dry white sheet.
  virtual void clear() = 0;

  // Gives a sleeping tile its pigment.
  virtual void lay(TilePlace place, const FixedPigment& pigment) = 0;
};

struct LatticeSetup {
  LatticeNumbers numbers;
  PaperTexture texture;
  int columns;  // of cells
  int rows;
  const StepKernels* kernels;
  ThreadPool* threads;
};

std::unique_ptr<Lattice> make_tiled_lattice(const LatticeSetup& setup);
std::unique_ptr<Lattice> make_dense_lattice(const LatticeSetup& setup);

inline int tiles_across(int cells) { return (cells + tile::side - 1) / tile::side; }

}  // namespace fude
