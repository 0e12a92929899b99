// A brush: poses of the handle in, marks on the paper out (Chu chapter 2).
//
// A thin shell around pure steps: arrangement.h says how it is made of tufts, tuft_step.h moves each,
// footprint.h sees where they touched, loading.h keeps the ink. Paper frame, millimetres; time from input.time.host. One thread at a time.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "signal/action.h"
#include "signal/brush_input.h"
#include "signal/ink_event.h"
#include "signal/paper_grain.h"
#include "signal/result.h"
#include "sim/brush/arrangement.h"
#include "sim/brush/brush_spec.h"
#include "sim/brush/dipping.h"
#include "sim/brush/footprint.h"
#include "sim/brush/hair_texture.h"
#include "sim/brush/loading.h"
#include "sim/brush/tuft_state.h"
#include "sim/brush/tuft_step.h"
#include "sim/brush/tuft_surface.h"

namespace fude {

// The footprint that the next is swept from: of the tufts as they stand.
struct Footprint {
  bool taken = false;
  double soak_mm = 0;           // by which the tufts were swollen
  std::vector<double> wetness;  // of each tuft, where they hang together in a row
};

// All that a brush remembers; copying it is a snapshot.
struct BrushState {
  std::vector<BrushTuft> tufts;            // a child after its parent
  Pose<Paper, Handle> paper_from_handle;  // as last followed: never lower than the brush allows
  Loading loading;
  Footprint footprint;
  bool timed = false;  // there is a last time
  Timestamp last{};
};

// The same state as bytes (little-endian, IEEE 754), and back; exact. Fails (malformed) on bytes that
// are no brush state.
std::vector<std::byte> bytes_of(const BrushState& state);
Result<BrushState> brush_state_of(std::span<const std::byte> bytes);

// What one call of move did. A long frame is solved in several steps: iterations, residual and violation are
// those of the worst step of any tuft, energy and the force on the hand those of all in the last.
struct BrushFrame {
  int steps = 0;
  SolveReport solve;
  std::optional<Deposit> deposit;  // none where nothing touches
};

// For display and tests: nodes of the spine, root to tip; lateral nodes a and b of each; sections.
struct TuftShape {
  std::vector<Eigen::Vector3d> spine;
  std::vector<Eigen::Vector3d> lateral_a;
  std::vector<Eigen::Vector3d> lateral_b;
  TuftSurface sections;
  PatchesOfBrush patches;
};
using BrushShape = std::vector<TuftShape>;

class Brush {
 public:
  explicit Brush(const BrushSpec& spec, std::uint64_t seed);

  // Follows the handle. Origin none, or a pose that is not finite: the brush is away; it springs back
  // and marks nothing. Time that stands still or runs backwards counts as no time.
  BrushFrame move(const BrushInput& input);

  // What the paper took in the oldest deposit not yet answered, net of what it gave back; the rig calls it
  // a fixed simulated time later.
  void take(const Exchange& exchange);

  // What a full brush leaves on newly covered dry paper. From now on that much of every deposit is set aside
  // until take says what it was. 0, as at first: nothing is.
  void expect_film(double ul_per_mm2);

  // The relief of the paper, which dry hair feels. None, as at first: it is flat.
  void paint_over(std::shared_ptr<PaperGrain> grain);

  // Follows the handle over a spot of the palette, whose surface lies in the plane of the paper: what of the
  // tuft is below it takes up, gives up or is wiped. Time counts as in move; after a gap none of it does.
  void visit(const BrushInput& input, const PaletteSpot& spot);

  // Fills, dips, rinses, wipes, blots or rolls it; wiping straightens it too.
  void tend(const BrushCare& care);
  void load(float wetness, const Concentrations& strength) { tend(LoadBrush{wetness, strength}); }
  void set_endless(bool endless);  // the tuft stays as loaded

  // Straightens the hair, as on the rim of the ink stone; keeps its ink.
  void reshape();

  const BrushSpec& spec() const { return tuft_.spec; }
  const BrushState& state() const { return state_; }
  // A state of a brush with other segments is an error of the caller (std::invalid_argument).
  void restore(const BrushState& state);
  BrushShape shape() const;

 private:
  double pass_time(const BrushInput& input);
  Immersion immersed(const BrushSurface& hair, double level_mm) const;
  // A tuft as it is made; what it remembers stands in the state.
  struct Made {
    Tuft tuft;
    HairTexture texture;
    PatchesOfBrush patches;
  };
  void grow(const std::vector<TuftRoot>& roots);
  void make_tufts();
  Pose<Paper, Handle> root_of(std::size_t tuft) const;
  std::vector<Bends> neighbours() const;
  SolveReport advance_tufts(double step_s, bool jumped);
  void away(double elapsed_s);
  BrushSurface surface(const std::vector<double>& row_wetness) const;
  BrushSurface marked_surface() const;
  std::vector<double> row_wetness() const;
  std::vector<TuftHair> hair() const;
  void take_footprint();
  std::vector<InkLoad> draw_for(const FootprintMap& map, double elapsed_s);

  Tuft tuft_;  // all the hair, as one tuft
  HairFlow flow_;
  std::uint64_t seed_;
  std::vector<Made> made_;  // follows the roots in state_.tufts
  std::shared_ptr<PaperGrain> grain_;
  double film_ul_mm2_ = 0;
  BrushState state_;
  FootprintSweep sweep_;  // follows state_.footprint
};

}  // namespace fude
