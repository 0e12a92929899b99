// The ink on a graphics card, by OpenGL 4.3 compute shaders made of the same kernel text as the processor's.
// Any thread may use it, one at a time; the context is current only inside a call.
#pragma once

#include <memory>

#include "sim/ink/ink.h"

namespace fude {

// A dry white sheet on a card, or on a software renderer where there is no card. The setup is in range.
// Errors: unsupported, where there is no OpenGL 4.3, the driver refuses a program or the card has no room.
Result<std::unique_ptr<Ink>> open_gl_ink(const InkSetup& setup);

// Whether a graphics card with OpenGL 4.3 is there; a software renderer is none.
bool graphics_card_exists();

}  // namespace fude
