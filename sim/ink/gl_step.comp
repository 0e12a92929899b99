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
Site own_site;

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
  int paper = address(spot.slot, paper_count, 0, spot.cell);
  return site_of(numbers, total(population_at(spot.slot, spot.cell)),
                 vec4(masses_now[mass], masses_now[mass + CELLS], masses_now[mass + 2 * CELLS],
                      masses_now[mass + 3 * CELLS]),
                 masses_now[mass + 4 * CELLS], paper_planes[paper], paper_planes[paper + CELLS],
                 paper_planes[paper + 2 * CELLS]);
}

float population_beside(int plane, int dx, int dy) {
  Spot spot = beside(dx, dy);
  return populations_now[address(spot.slot, population_planes, plane, spot.cell)];
}

const int plane_e = 1, plane_n = 2, plane_w = 3, plane_s = 4, plane_ne = 5, plane_nw = 6, plane_sw = 7, plane_se = 8;

struct SideOf {
  int e, n, ne, nw;
};
const SideOf side_of = SideOf(0, 1, 2, 3);

// The link from the cell at (dx, dy) on one of its sides; one end of it is this cell.
Crossing link(int side, int dx, int dy) {
  bool from_here = dx == 0 && dy == 0;
  int x = dx + (side == side_of.n ? 0 : side == side_of.nw ? -1 : 1);
  int y = dy + (side == side_of.e ? 0 : 1);
  int out_plane = side == side_of.e ? plane_e : side == side_of.n ? plane_n : side == side_of.ne ? plane_ne : plane_nw;
  int back_plane = side == side_of.e ? plane_w : side == side_of.n ? plane_s : side == side_of.ne ? plane_sw : plane_se;
  bool straight = side == side_of.e || side == side_of.n;
  Site near = own_site;
  Site far = own_site;
  if (from_here)
    far = site_beside(x, y);
  else
    near = site_beside(dx, dy);
  return crossing(numbers, near, far, straight ? near.head : near.diagonal_head,
                  straight ? far.head : far.diagonal_head, straight ? numbers.pace_straight : numbers.pace_diagonal,
                  population_beside(out_plane, dx, dy), population_beside(back_plane, x, y));
}

#define CELL_PARAMETERS
#define CROSSING(side, dx, dy) link(side_of.side, dx, dy)
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
  own_site = site_beside(0, 0);
  step_cell(numbers, numbers.relaxation > 1.0, own_site, before, mass, surface, surface_mass, fixed_mass, after, water, evaporated);

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
