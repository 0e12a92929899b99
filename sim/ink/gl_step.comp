// One ink step of every awake tile: work-groups run along x over the cells of a tile and along y over the
// tiles. Each cell derives its neighbours' sites anew; the caches hold what they share.
#include "lang_glsl.inc"
#include "numeric.k"
#include "site.k"
#include "link.k"
#include "collide.k"
#include "dry.k"
#include "gl_tiles.inc"
layout(local_size_x = 64) in;
layout(std430, binding = 1) restrict writeonly buffer PopulationsNext { float populations_next[]; };
layout(std430, binding = 2) restrict readonly buffer MassesNow { float masses_now[]; };
layout(std430, binding = 3) restrict writeonly buffer MassesNext { float masses_next[]; };
layout(std430, binding = 5) restrict readonly buffer PaperPlanes { float paper_planes[]; };
layout(std430, binding = 6) restrict readonly buffer Neighbours { int neighbours[]; };  // nine slots a tile

const int mass_planes = 5;  // four masses, then the fixed ink
const int paper_count = 3;  // blocking, grain, toe

int cell_x;
int cell_y;
int tile_begin;

struct Spot {
  int slot;
  int cell;
};

Spot beside(int dx, int dy) {
  int x = cell_x + dx;
  int y = cell_y + dy;
  int across = x < 0 ? 0 : x < SIDE ? 1 : 2;
  int up = y < 0 ? 0 : y < SIDE ? 1 : 2;
  return Spot(neighbours[tile_begin + 3 * up + across], (y & (SIDE - 1)) * SIDE + (x & (SIDE - 1)));
}

Site site_beside(int dx, int dy) {
  Spot spot = beside(dx, dy);
  int mass = address(spot.slot, mass_planes, 0, spot.cell);
  return site_of(numbers, total(population_at(spot.slot, spot.cell)),
                 vec4(masses_now[mass], masses_now[mass + CELLS], masses_now[mass + 2 * CELLS],
                      masses_now[mass + 3 * CELLS]),
                 masses_now[mass + 4 * CELLS], paper_planes[address(spot.slot, paper_count, 0, spot.cell)]);
}

Relief relief_beside(int dx, int dy) {
  Spot spot = beside(dx, dy);
  int at = address(spot.slot, paper_count, 1, spot.cell);
  return Relief(paper_planes[at], paper_planes[at + CELLS]);
}

float arriving(int plane, int dx, int dy) {
  Spot spot = beside(dx, dy);
  return populations_now[address(spot.slot, population_planes, plane, spot.cell)];
}

struct PlaneOf {
  int rest, e, n, w, s, ne, nw, sw, se;
};
const PlaneOf plane_of = PlaneOf(0, 1, 2, 3, 4, 5, 6, 7, 8);

#define CELL_PARAMETERS
#define SITE(dx, dy) site_beside(dx, dy)
#define RELIEF(dx, dy) relief_beside(dx, dy)
#define ARRIVING(member, dx, dy) arriving(plane_of.member, dx, dy)
#include "step.k"

void main() {
  int cell = int(gl_GlobalInvocationID.x);
  cell_x = cell & (SIDE - 1);
  cell_y = cell / SIDE;
  tile_begin = int(gl_WorkGroupID.y) * 9;
  int slot = neighbours[tile_begin + 4];

  Population before = population_at(slot, cell);
  int masses = address(slot, mass_planes, 0, cell);
  vec4 mass = vec4(masses_now[masses], masses_now[masses + CELLS], masses_now[masses + 2 * CELLS],
                   masses_now[masses + 3 * CELLS]);
  int still_begin = address(slot, still_count, 0, cell);
  float surface = still_planes[still_begin];
  vec4 surface_mass = still_quad(still_begin + CELLS);
  vec4 fixed_mass = still_quad(still_begin + 5 * CELLS);
  Population after;
  float water;
  float evaporated;
  step_cell(numbers, before, mass, surface, surface_mass, fixed_mass, after, water, evaporated);

  int to = address(slot, population_planes, 0, cell);
  populations_next[to] = after.rest;
  populations_next[to + CELLS] = after.e;
  populations_next[to + 2 * CELLS] = after.n;
  populations_next[to + 3 * CELLS] = after.w;
  populations_next[to + 4 * CELLS] = after.s;
  populations_next[to + 5 * CELLS] = after.ne;
  populations_next[to + 6 * CELLS] = after.nw;
  populations_next[to + 7 * CELLS] = after.sw;
  populations_next[to + 8 * CELLS] = after.se;
  masses_next[masses] = mass.x;
  masses_next[masses + CELLS] = mass.y;
  masses_next[masses + 2 * CELLS] = mass.z;
  masses_next[masses + 3 * CELLS] = mass.w;
  precise float fixed_ink = (fixed_mass.x + fixed_mass.y) + (fixed_mass.z + fixed_mass.w);
  masses_next[masses + 4 * CELLS] = fixed_ink;
  still_planes[still_begin] = surface;
  put_still_quad(still_begin + CELLS, surface_mass);
  put_still_quad(still_begin + 5 * CELLS, fixed_mass);
  still_planes[still_begin + evaporated_plane * CELLS] = evaporated;
  still_planes[still_begin + wet_plane * CELLS] = water + surface;
}
