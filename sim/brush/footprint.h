// From the surface of a brush's tufts at a few times to the map of what they newly covered and how long they
// touched (Chu 2.7). Between two times the surface is carried along in a straight line, in steps finer than
// what a fast stroke would leave gaps between. What several tufts cover counts once.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "signal/ink_event.h"
#include "sim/brush/contact_mesh.h"
#include "sim/brush/coverage.h"
#include "sim/brush/stamp.h"
#include "sim/brush/tuft_surface.h"
#include "sim/brush/winding_fill.h"

namespace fude {

using BrushSurface = std::vector<TuftSurface>;  // tuft by tuft

struct TimedSurface {
  BrushSurface surface;
  double since_last_s = 0;  // from the surface before it
};

// Remembers the last surface and what it covered. That and its memory are all that it keeps: after
// come_from with the same surface it goes on with the same bits.
class FootprintSweep {
 public:
  // Where the tufts are to be swept from; what they cover there is not new.
  void come_from(const BrushSurface& surface);
  // The tufts come from nowhere: all they cover is new, and nothing is known of the time before.
  void come_from_nowhere();

  // The footprint swept through `after`, in order, of hair that looks so; its loads are those of the patches
  // that the map names. None where nothing touched. As many tufts as swept from; `cell_mm` is the same in
  // all calls.
  std::optional<FootprintMap> sweep(std::span<const TimedSurface> after, double cell_mm,
                                    const HairLook& look);

 private:
  // A contact on the way, with the share of time it stands for.
  struct Instant {
    std::vector<ContactMesh> contacts;  // tuft by tuft
    double duration_s = 0;
    bool ends_step = false;  // the tufts were solved for here
    void take(const BrushSurface& surface);
    void add_to(WindingFill& filling) const;
  };
  Instant& append_instant();
  void find_instants(std::span<const TimedSurface> after);
  std::optional<CoverageFrame> frame_of_instants(double cell_mm) const;
  void find_coverage(const CoverageFrame& frame, FootprintMap& map);
  void stamp(FootprintMap& map, const HairLook& look) const;

  BrushSurface last_;  // empty: from nowhere
  bool settled_known_ = false;
  std::vector<Instant> instants_;  // the first `count_` hold; the others lend their memory
  std::size_t count_ = 0;
  WindingFill filling_;
  Coverage settled_;  // by the last solved surface
  Coverage now_;
  Coverage passed_;  // since the last solved surface
  Coverage fresh_;
  Coverage touched_;
};

}  // namespace fude
