// The tuft over the paper, and the shadow that tells how high it hangs.
#pragma once

#include "app/studio/view.h"
#include "sim/brush/brush.h"

struct ImDrawList;

namespace fude {

void draw_tuft(ImDrawList& canvas, const View& view, const TuftShape& tuft);

}  // namespace fude
