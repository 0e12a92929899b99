// The tuft over the paper in the window, transparent, with the shadow that tells how high it hangs: the same
// picture that `fude brushes show` draws, seen from above. For the thread whose OpenGL context is current.
#pragma once

#include <span>

#include "app/studio/view.h"
#include "rig/brush_view/tuft_insides.h"
#include "rig/brush_view/tuft_look.h"
#include "sim/brush/brush.h"

struct ImDrawList;

namespace fude {

// How the painter wants to see the brush.
struct BrushDisplay {
  TuftLook look = TuftLook::shaded;
  bool development = false;  // skeleton, contacts, blocking plane; the hair as an outline
};

class TuftDrawing {
 public:
  explicit TuftDrawing(Palette palette);
  ~TuftDrawing();
  TuftDrawing(const TuftDrawing&) = delete;
  TuftDrawing& operator=(const TuftDrawing&) = delete;

  void draw(ImDrawList& canvas, const View& view, std::span<const SeenTuft> tufts, TuftLook look);

 private:
  Palette palette_;
  unsigned texture_ = 0;
};

// `converged`: whether the last frame was solved; one that was not is drawn in red.
void draw_insides(ImDrawList& canvas, const View& view, const BrushShape& brush, const TuftInsides& insides,
                  bool converged);

}  // namespace fude
