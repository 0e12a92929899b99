// A sheet of paper with ink on it: what the rest of the program sees of the ink.
//
// Paper frame: millimetres, x to the right, y up the sheet, origin in its lower left corner. Cells count
// from there: column 0, row 0 is the lower left one. A step is a fixed time; nothing depends on the clock.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "signal/ink_event.h"
#include "signal/result.h"
#include "sim/compute/instruction_set.h"
#include "sim/ink/paper.h"

namespace fude {

enum class InkBackend { cpu, gl };

// OpenGL 4.3 or later on a graphics card, never a software renderer; else the processor.
InkBackend best_ink_backend();

struct InkSetup {
  PaperSpec paper;
  double width_mm = 210;
  double height_mm = 297;
  double cell_mm = 0.1;  // 0.02 to 1
  InkBackend backend = InkBackend::cpu;
  std::optional<InstructionSet> instruction_set;  // none: the widest of this processor
  int threads = 1;
  std::uint64_t seed = 1;  // of the paper's textures
  bool flow = true;        // false: ink dries where it was laid
  bool dense = false;      // every cell is stepped, wet or not: the reference, and slow
};

struct CellRect {
  int left = 0;
  int bottom = 0;
  int columns = 0;
  int rows = 0;
};

// Water in µl, pigment in µl of full-strength ink, summed in double in a fixed order. What was deposited is
// net of what brushes took back: water deposited = evaporated + left, pigment deposited = surface + flow +
// fixed.
struct InkTotals {
  using Pigments = std::array<double, concentrations_per_group>;
  double water_deposited = 0;
  double water_evaporated = 0;
  double water_left = 0;
  Pigments pigment_deposited{};
  Pigments pigment_surface{};
  Pigments pigment_flow{};
  Pigments pigment_fixed{};
};

// Cells of a rectangle, row by row from the bottom.
struct InkRegion {
  CellRect rect;
  std::vector<float> flow_water;        // of saturation, 0 to about 1
  std::vector<float> surface_water;     // standing on the paper, in the same unit
  std::vector<Concentrations> pigment;  // µl/mm² of full-strength ink, surface + flow + fixed; and glue
};

// All state of a sheet between two steps; restoring it is exact. Holds only what is wet or stained.
struct InkSnapshot {
  struct Tile {
    int column;
    int row;
    bool wet;                   // else only the fixed planes
    std::vector<float> planes;  // plane by plane as tile_layout.h orders them
  };
  std::vector<Tile> tiles;
  std::uint64_t steps = 0;
  double water_deposited = 0;
  double water_evaporated = 0;
  InkTotals::Pigments pigment_deposited{};
  std::vector<Exchange> pending;  // of events since the last step
  std::vector<Exchange> ready;    // not yet collected
};

// Where memory or a graphics card gives out, any call but the plain numbers throws std::bad_alloc or a
// std::runtime_error that says so in one line.
class Ink {
 public:
  virtual ~Ink() = default;

  virtual int columns() const = 0;  // ceil(width / cell)
  virtual int rows() const = 0;
  virtual double cell_mm() const = 0;
  virtual double step_s() const = 0;  // simulated seconds of a step

  // Between steps. What would fall off the sheet stays on the brush.
  virtual void apply(const InkEvent& event) = 0;
  virtual void step() = 0;

  // What the paper took in the events applied so far, in their order: as soon as it is known, at the
  // latest for those applied before the last finished step.
  virtual std::vector<Exchange> collect() = 0;

  virtual InkTotals totals() const = 0;
  virtual std::uint64_t steps() const = 0;
  virtual std::size_t active_cells() const = 0;  // of the tiles that are stepped
  // The smallest rectangle around those tiles, cut to the sheet; no columns where there are none.
  virtual CellRect active_rect() const = 0;
  virtual bool still() const = 0;  // no water anywhere: a step would change nothing

  // rect is cut to the sheet. 24 bytes a cell: read large sheets in strips.
  virtual InkRegion read(const CellRect& rect) const = 0;

  // `memory`: a snapshot that is not needed any more, to be written over; new memory costs more than the
  // copy.
  virtual InkSnapshot snapshot(InkSnapshot memory) const = 0;
  InkSnapshot snapshot() const { return snapshot({}); }
  virtual void restore(const InkSnapshot& snapshot) = 0;

  // Of all state, the same for tiles and dense, and for any tile awake or asleep.
  virtual std::uint64_t hash() const = 0;
};

// A dry white sheet. Fault::usage where sizes are out of range, Fault::unsupported where the back-end or
// the instruction set is missing here.
Result<std::unique_ptr<Ink>> open_ink(const InkSetup& setup);

}  // namespace fude
