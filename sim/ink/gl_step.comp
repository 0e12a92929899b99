// One ink step of every awake tile: work-groups run along x over the cells of a tile and along y over the
// tiles. Each cell computes its eight links, from what the cells around it show, and shows itself for the next
// step.
#include "lang_glsl.inc"
#include "numeric.k"
#include "site.k"
#include "shown.k"
#include "link.k"
#include "collide.k"
#include "dry.k"
#include "gl_tiles.inc"
layout(local_size_x = 256) in;
layout(binding = 2) uniform samplerBuffer shown_now;
layout(binding = 3) uniform samplerBuffer pigment_now;  // masses in the flow layer, fixed masses
layout(binding = 4) uniform samplerBuffer paper;        // blocking, grain, toe
layout(std430, binding = 0) restrict writeonly buffer Moving { vec4 moving_next[]; };
layout(std430, binding = 1) restrict writeonly buffer Surfaces { vec4 surface_next[]; };
layout(std430, binding = 2) restrict writeonly buffer Sites { vec4 shown_next[]; };
layout(std430, binding = 3) restrict writeonly buffer Pigment { vec4 pigment_next[]; };

vec4 own_straight;
vec4 own_diagonal;
Site own_site;

// Where the nine cells around this one begin, from below left, this one being number 4.
int around[9];
int own_slot;

int pair_beside(int dx, int dy) { return around[4 + 3 * dy + dx]; }

void look_around(int cell_x, int cell_y, int tile) {
  int west_x = (cell_x - 1) & (SIDE - 1);
  int east_x = (cell_x + 1) & (SIDE - 1);
  for (int i = 0; i < 3; ++i) {
    int y = cell_y + i - 1;
    int up = y < 0 ? 0 : y < SIDE ? 1 : 2;
    ivec3 slots = texelFetch(neighbours, 3 * tile + up).xyz;
    if (i == 1) own_slot = slots.y;
    int row = (y & (SIDE - 1)) * SIDE;
    around[3 * i] = pair_at(cell_x == 0 ? slots.x : slots.y, row + west_x);
    around[3 * i + 1] = pair_at(slots.y, row + cell_x);
    around[3 * i + 2] = pair_at(cell_x == SIDE - 1 ? slots.z : slots.y, row + east_x);
  }
}

// What a neighbour shows, and its population in the direction of component `plane`.
Site site_beside(int pair) {
  return site_shown(Shown(texelFetch(shown_now, pair), texelFetch(shown_now, pair + 1)));
}

// Opposite directions of a texel of populations are two components apart.
const int side_e = 0, side_n = 1, side_ne = 4, side_nw = 5;

// The link from the cell at (dx, dy) on one of its sides; one end of it is this cell.
Crossing link(int side, int dx, int dy) {
  bool from_here = dx == 0 && dy == 0;
  bool straight = side < 4;
  int out_plane = side & 3;
  int back_plane = out_plane ^ 2;
  int x = side == side_n ? 0 : side == side_nw ? -1 : 1;
  int y = side == side_e ? 0 : 1;
  int pair = from_here ? pair_beside(x, y) : pair_beside(dx, dy);
  Site other = site_beside(pair);
  vec4 theirs = texelFetch(moving_now, straight ? pair : pair + 1);
  vec4 ours = straight ? own_straight : own_diagonal;
  float own_head = straight ? own_site.head : own_site.diagonal_head;
  float other_head = straight ? other.head : other.diagonal_head;
  float pace = straight ? numbers.pace_straight : numbers.pace_diagonal;
  if (from_here)
    return crossing(numbers, own_site, other, own_head, other_head, pace, ours[out_plane], theirs[back_plane]);
  return crossing(numbers, other, own_site, other_head, own_head, pace, theirs[out_plane], ours[back_plane]);
}

#define CELL_PARAMETERS
#define CROSSING(side, dx, dy) link(side_##side, dx, dy)
#include "step.k"

void main() {
  int cell = int(gl_GlobalInvocationID.x);
  look_around(cell & (SIDE - 1), cell / SIDE, int(gl_WorkGroupID.y));
  int pair = around[4];

  own_straight = texelFetch(moving_now, pair);
  own_diagonal = texelFetch(moving_now, pair + 1);
  vec4 surface_mass = texelFetch(surface_now, pair);
  vec4 levels = texelFetch(surface_now, pair + 1);
  vec4 mass = texelFetch(pigment_now, pair);
  vec4 fixed_mass = texelFetch(pigment_now, pair + 1);
  vec4 textures = texelFetch(paper, own_slot * CELLS + cell);
  Population before = population_of(levels[rest_level], own_straight, own_diagonal);
  own_site = site_beside(pair);
  own_site.water = total(before);
  own_site.per_water = reciprocal(greatest(own_site.water, 1e-20));
  float surface = levels[surface_level];
  Population after;
  float water;
  float evaporated;
  step_cell(numbers, numbers.relaxation > 1.0, own_site, before, mass, surface, surface_mass, fixed_mass, after,
            water, evaporated);

  precise float fixed_ink = (fixed_mass.x + fixed_mass.y) + (fixed_mass.z + fixed_mass.w);
  Shown seen = shown(site_of(numbers, total(after), mass, fixed_ink, textures.x, textures.y, textures.z));
  moving_next[pair] = vec4(after.e, after.n, after.w, after.s);
  moving_next[pair + 1] = vec4(after.ne, after.nw, after.sw, after.se);
  shown_next[pair] = seen.concentration;
  shown_next[pair + 1] = seen.front;
  surface_next[pair] = surface_mass;
  surface_next[pair + 1] = vec4(surface, after.rest, evaporated, water + surface);
  pigment_next[pair] = mass;
  pigment_next[pair + 1] = fixed_mass;
}
