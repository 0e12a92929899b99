// A touch of the brush. One invocation a cell; where several patches touch it they follow one another, in
// the order of the processor's back-end.
#include "lang_glsl.inc"
#include "numeric.k"
#include "site.k"
#include "deposit.k"
#include "gl_tiles.inc"
layout(local_size_x = 64) in;

struct Cell {
  int slot;
  int cell;
  int first;  // its touches
  int touches;
};
struct Touch {
  vec4 strength;
  float wetness;
  float fresh;
  float contact;
  float unused;
};
struct Taken {
  vec4 mass;
  float water;
  float unused_1, unused_2, unused_3;
};
layout(std430, binding = 1) restrict readonly buffer Cells { Cell cells[]; };
layout(std430, binding = 2) restrict readonly buffer Touches { Touch touches[]; };
layout(std430, binding = 3) restrict writeonly buffer Takings { Taken takings[]; };
layout(std430, binding = 4) restrict writeonly buffer Surface { vec4 surface_next[]; };

uniform int count;  // cells

void main() {
  int index = int(gl_GlobalInvocationID.x);
  if (index < count) {
    Cell cell = cells[index];
    int pair = pair_at(cell.slot, cell.cell);
    vec4 surface_mass = texelFetch(surface_now, pair);
    vec4 levels = texelFetch(surface_now, pair + 1);
    float water = total(population_of(levels[rest_level], texelFetch(moving_now, pair),
                                      texelFetch(moving_now, pair + 1)));
    float surface = levels[surface_level];
    for (int i = cell.first; i < cell.first + cell.touches; ++i) {
      Touch t = touches[i];
      float taken;
      vec4 taken_mass;
      touch(numbers, water, t.wetness, t.strength, t.fresh, t.contact, surface, surface_mass, taken, taken_mass);
      takings[i] = Taken(taken_mass, taken, 0.0, 0.0, 0.0);
    }
    levels[surface_level] = surface;
    surface_next[pair] = surface_mass;
    surface_next[pair + 1] = levels;
  }
}
