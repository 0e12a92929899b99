// From the tuft's surface at a few times to the map of what it newly covered and how long it touched
// (Chu 2.7). Between two times the surface is carried along in a straight line, in steps finer than
// what a fast stroke would leave gaps between.
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

struct TimedSurface {
  TuftSurface surface;
  double since_last_s = 0;  // from the surface before it
};

// Remembers the last surface and what it covered. That and its memory are all that it keeps: after
// come_from with the same surface it goes on with the same bits.
class FootprintSweep {
 public:
  // Where the tuft is to be swept from; what it covers there is not new.
  void come_from(const TuftSurface& surface);
  // The tuft comes from nowhere: all it covers is new, and nothing is known of the time before.
  void come_from_nowhere();

  // The footprint swept through `after`, in order, of hair that looks so; its loads are those of the patches
  // that the map names. None where nothing touched. `cell_mm` is the same in all calls.
  std::optional<FootprintMap> sweep(std::span<const TimedSurface> after, double cell_mm,
                                    const HairLook& look);

 private:
  // A contact on the way, with the share of time it stands for.
  struct Instant {
    ContactMesh contact;
    double duration_s = 0;
    bool ends_step = false;  // the tuft was solved for here
  };
  Instant& append_instant();
  void find_instants(std::span<const TimedSurface> after);
  std::optional<CoverageFrame> frame_of_instants(double cell_mm) const;
  void find_coverage(const CoverageFrame& frame, FootprintMap& map);
  void stamp(FootprintMap& map, const HairLook& look) const;

  TuftSurface last_;  // empty: from nowhere
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
