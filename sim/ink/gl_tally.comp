// After a step, each column of each awake tile: adds up what evaporated, from the bottom, and notes where
// water is. 64 columns a work-group.
#include "lang_glsl.inc"
#include "numeric.k"
#include "site.k"
#include "gl_tiles.inc"
layout(local_size_x = 64) in;

struct Column {
  double evaporated;  // since the buffer was made, whatever tiles had the slot
  uint wet;           // bit 0: near the bottom, 1: near the top (MARGIN cells), 2: anywhere
  uint unused;
};
layout(std430, binding = 7) restrict buffer Columns { Column columns[]; };

uniform int count;  // columns of all awake tiles

void main() {
  int index = int(gl_GlobalInvocationID.x);
  if (index < count) {
    int x = index & (SIDE - 1);
    int slot = texelFetch(neighbours, 3 * (index / SIDE) + 1).y;
    int at = pair_at(slot, x) + 1;
    double evaporated = columns[slot * SIDE + x].evaporated;
    uint wet = 0u;
    for (int y = 0; y < SIDE; ++y) {
      vec4 levels = texelFetch(surface_now, at + 2 * y * SIDE);
      evaporated += double(levels[evaporated_level]);
      uint bits = (y < MARGIN ? 1u : 0u) | (y >= SIDE - MARGIN ? 2u : 0u) | 4u;
      wet |= levels[wet_level] > 0.0 ? bits : 0u;
    }
    columns[slot * SIDE + x].evaporated = evaporated;
    columns[slot * SIDE + x].wet = wet;
  }
}
