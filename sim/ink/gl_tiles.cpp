#include "sim/ink/gl_tiles.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace fude {
namespace {

constexpr std::size_t pair_bytes = pair_floats * sizeof(float);
constexpr std::size_t paper_bytes = paper_floats * sizeof(float);
constexpr std::size_t first_slots = 64;
constexpr std::uint32_t step_group = 256;  // invocations, as gl_step.comp has it
constexpr int outside = 0;  // the slot that stands for what is off the sheet or asleep: dry and closed

// A report of the water is heard so many steps after it was sent, and only one is under way; so a front is
// heard of at most 2 · report_age steps late, and has come at most that many cells nearer.
constexpr std::uint64_t report_age = 3;
static_assert(2 * report_age < wet_margin);
constexpr std::uint64_t steps_between_sweeps = 32;

// As gl_tally.comp has it.
struct Column {
  double evaporated;
  std::uint32_t wet;
  std::uint32_t unused;
};
// The slots of three tiles side by side, and padding.
using SlotRow = std::array<std::int32_t, 4>;
constexpr std::uint32_t near_bottom = 1;
constexpr std::uint32_t near_top = 2;
constexpr std::uint32_t anywhere = 4;
constexpr std::uint16_t every_edge = (1U << tile::neighbourhood) - 1;

TilePlace beside(TilePlace place, std::size_t i) {
  return {place.row + static_cast<int>(i / 3) - 1, place.column + static_cast<int>(i % 3) - 1};
}

std::size_t offset(int slot, std::size_t bytes_a_slot) {
  return static_cast<std::size_t>(slot) * bytes_a_slot;
}

// A tile's planes one after the other, at first all nought.
struct Planes {
  std::vector<float> memory = std::vector<float>(tile::planes * tile::cells);
  PlaneView view{memory.data(), tile::side, tile::cells};

  void lay(std::size_t first, const float* from, std::size_t count) {
    std::copy_n(from, count * tile::cells, view.cells(first, 0));
  }
};

template <class T>
T require(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

}  // namespace

GlTiles::GlTiles(const LatticeNumbers& numbers, const PaperTexture& texture, int columns, int rows)
    : numbers_(numbers), texture_(texture), columns_(columns), rows_(rows) {}

Result<GlTiles> GlTiles::make(const LatticeNumbers& numbers, const PaperTexture& texture, int columns,
                              int rows) {
  GlTiles tiles(numbers, texture, columns, rows);
  auto block = GlBuffer::make((sizeof(LatticeNumbers) + 15) / 16 * 16);
  if (!block) return tl::unexpected(block.error());
  tiles.number_block_ = std::move(*block);
  tiles.number_block_.write(0, std::as_bytes(std::span(&numbers, 1)));
  if (auto grown = tiles.grow(first_slots); !grown) return tl::unexpected(grown.error());
  tiles.free_.pop_back();
  Planes closed;
  std::fill_n(closed.view.cells(tile::paper_begin + tile::blocking, 0), tile::cells, tile::closed_blocking);
  std::fill_n(closed.view.cells(tile::paper_begin + tile::grain, 0), tile::cells, tile::closed_grain);
  const TileTexels texels = texels_of(numbers, closed.view);
  for (const GlTexels& shown : tiles.shown_)
    shown.buffer().write(offset(outside, pair_bytes), bytes_of(texels.shown));
  return tiles;
}

bool GlTiles::on_sheet(TilePlace place) const {
  return place.row >= 0 && place.column >= 0 && place.row < tiles_across(rows_) &&
         place.column < tiles_across(columns_);
}

Result<void> GlTiles::grow(std::size_t slots) {
  GLint64 most = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
  if (slots * pair_bytes > static_cast<std::size_t>(most))
    return failure(Fault::unsupported,
                   "the graphics card has no room for so much wet paper: use --backend cpu or larger cells");
  const auto enlarge = [&](GlBuffer& buffer, std::size_t bytes_a_slot) -> Result<void> {
    auto larger = GlBuffer::make(slots * bytes_a_slot);
    if (!larger) return tl::unexpected(larger.error());
    if (slots_ > 0) buffer.copy_to(*larger, 0, 0, slots_ * bytes_a_slot);
    buffer = std::move(*larger);
    return {};
  };
  const auto enlarge_texels = [&](GlTexels& texels, std::size_t bytes_a_slot) -> Result<void> {
    auto larger = GlTexels::make(slots * bytes_a_slot);
    if (!larger) return tl::unexpected(larger.error());
    if (slots_ > 0) texels.buffer().copy_to(larger->buffer(), 0, 0, slots_ * bytes_a_slot);
    texels = std::move(*larger);
    return {};
  };
  for (GlTexels* pairs : {&moving_[0], &moving_[1], &shown_[0], &shown_[1], &surface_, &pigment_})
    if (auto done = enlarge_texels(*pairs, pair_bytes); !done) return done;
  if (auto done = enlarge_texels(paper_, paper_bytes); !done) return done;
  if (auto done = enlarge(column_sums_, tile::side * sizeof(Column)); !done) return done;
  auto neighbours = GlTexels::make(slots * sizeof(std::array<SlotRow, 3>), GlTexels::Kind::ints);
  if (!neighbours) return tl::unexpected(neighbours.error());
  neighbours_ = std::move(*neighbours);
  neighbours_written_ = false;
  for (std::size_t slot = slots; slot-- > slots_;) free_.push_back(static_cast<int>(slot));
  slots_ = slots;
  return {};
}

int GlTiles::free_slot() {
  if (free_.empty()) require(grow(2 * slots_).map([] { return 0; }));
  const int slot = free_.back();
  free_.pop_back();
  return slot;
}

GlTiles::Awake& GlTiles::wake(TilePlace place) {
  if (const auto found = awake_.find(place); found != awake_.end()) return found->second;
  const int slot = free_slot();
  if (sleepers_.contains(place)) collect_sleepers();
  const auto kept = asleep_.find(place);
  put_fixed(slot, place, kept == asleep_.end() ? FixedPigment(4 * tile::cells) : kept->second);
  if (kept != asleep_.end()) asleep_.erase(kept);
  neighbours_written_ = false;
  return awake_[place] = {slot, 0, steps_};
}

void GlTiles::put(int slot, const TileTexels& texels) {
  const auto p = static_cast<std::size_t>(parity_);
  const std::size_t at = offset(slot, pair_bytes);
  moving_[p].buffer().write(at, bytes_of(texels.moving));
  shown_[p].buffer().write(at, bytes_of(texels.shown));
  surface_.buffer().write(at, bytes_of(texels.surface));
  pigment_.buffer().write(at, bytes_of(texels.pigment));
  paper_.buffer().write(offset(slot, paper_bytes), bytes_of(texels.paper));
}

// A dry tile.
void GlTiles::put_fixed(int slot, TilePlace place, const FixedPigment& pigment) {
  Planes planes;
  texture_.fill(place.column * tile::side, place.row * tile::side, planes.view);
  planes.lay(tile::still_begin + tile::fixed_mass, pigment.data(), 4);
  put(slot, texels_of(numbers_, planes.view));
}

int GlTiles::pour(TilePlace place) {
  for (std::size_t i = 0; i < tile::neighbourhood; ++i)
    if (on_sheet(beside(place, i))) wake(beside(place, i));
  Awake& poured = awake_.at(place);
  poured.wet = every_edge;
  poured.since = steps_;
  return poured.slot;
}

void GlTiles::step(const GlInkPrograms& programs) {
  if (report_ && steps_ >= report_->step + report_age) {
    hear(*report_);
    report_.reset();
    wake_where_water_comes();
    if (steps_ % steps_between_sweeps <= report_age) sleep_where_none_can_come();
  }
  if (!neighbours_written_) write_neighbours();
  const auto now = static_cast<std::size_t>(parity_);
  number_block_.bind_uniforms(0);
  moving_[now].bind_texture(0);
  surface_.bind_texture(1);
  shown_[now].bind_texture(2);
  pigment_.bind_texture(3);
  paper_.bind_texture(4);
  moving_[1 - now].buffer().bind_storage(0);
  surface_.buffer().bind_storage(1);
  shown_[1 - now].buffer().bind_storage(2);
  pigment_.buffer().bind_storage(3);
  neighbours_.bind_texture(5);
  column_sums_.bind_storage(7);
  if (!awake_.empty()) {
    const auto count = static_cast<std::uint32_t>(awake_.size());
    programs.step.run(tile::cells / step_group, count);
    programs.tally.set("count", static_cast<int>(count) * tile::side);
    programs.tally.run((count * tile::side + 63) / 64);
  }
  parity_ = 1 - parity_;
  ++steps_;
  if (!report_)
    report_ = {steps_, require(GlReadBack::begin(column_sums_, 0, slots_ * tile::side * sizeof(Column)))};
}

std::uint16_t GlTiles::wet_bits(std::span<const std::byte> columns, int slot) const {
  unsigned left = 0;
  unsigned middle = 0;
  unsigned right = 0;
  for (int x = 0; x < tile::side; ++x) {
    Column column;
    std::memcpy(&column,
                columns.data() + (static_cast<std::size_t>(slot) * tile::side + static_cast<std::size_t>(x)) *
                                     sizeof(Column),
                sizeof column);
    middle |= column.wet;
    if (x < wet_margin) left |= column.wet;
    if (x >= tile::side - wet_margin) right |= column.wet;
  }
  const auto bit = [](unsigned bits, std::uint32_t where, unsigned neighbour) {
    return static_cast<std::uint16_t>(((bits & where) != 0 ? 1U : 0U) << neighbour);
  };
  return static_cast<std::uint16_t>(
      bit(left, near_bottom, 0) | bit(middle, near_bottom, 1) | bit(right, near_bottom, 2) |
      bit(left, anywhere, 3) | bit(middle, anywhere, 4) | bit(right, anywhere, 5) | bit(left, near_top, 6) |
      bit(middle, near_top, 7) | bit(right, near_top, 8));
}

void GlTiles::hear(const Report& report) {
  const std::vector<std::byte> columns = report.columns.collect();
  for (auto& [place, t] : awake_)
    if (t.since < report.step) t.wet = wet_bits(columns, t.slot);
}

void GlTiles::wake_where_water_comes() {
  std::vector<TilePlace> reached;
  for (const auto& [place, t] : awake_)
    for (std::size_t i = 0; i < tile::neighbourhood; ++i)
      if ((t.wet >> i & 1) != 0 && on_sheet(beside(place, i))) reached.push_back(beside(place, i));
  for (TilePlace place : reached) wake(place);
}

// A dry tile may sleep only when no neighbour's edge beside it is wet.
void GlTiles::sleep_where_none_can_come() {
  std::map<TilePlace, bool> needed;
  for (const auto& [place, t] : awake_)
    for (std::size_t i = 0; i < tile::neighbourhood; ++i)
      if ((t.wet >> i & 1) != 0) needed[beside(place, i)] = true;
  collect_sleepers();
  for (auto at = awake_.begin(); at != awake_.end();) {
    if (needed.contains(at->first)) {
      ++at;
      continue;
    }
    fall_asleep(at->first, at->second.slot);
    at = awake_.erase(at);
    neighbours_written_ = false;
  }
}

void GlTiles::fall_asleep(TilePlace place, int slot) {
  sleepers_[place] = require(GlReadBack::begin(pigment_.buffer(), offset(slot, pair_bytes), pair_bytes));
  free_.push_back(slot);
}

void GlTiles::collect_sleepers() {
  for (const auto& [place, back] : sleepers_) {
    const std::vector<std::byte> bytes = back.collect();
    std::vector<float> texels(pair_floats);
    std::memcpy(texels.data(), bytes.data(), bytes.size());
    FixedPigment pigment = fixed_masses(texels);
    if (std::ranges::any_of(pigment, [](float m) { return m != 0; })) asleep_[place] = std::move(pigment);
  }
  sleepers_.clear();
}

void GlTiles::write_neighbours() {
  std::vector<SlotRow> slots(awake_.size() * 3);
  std::size_t first = 0;
  for (const auto& [place, t] : awake_) {
    for (std::size_t i = 0; i < tile::neighbourhood; ++i) {
      const auto found = awake_.find(beside(place, i));
      slots[first + i / 3][i % 3] = found == awake_.end() ? outside : found->second.slot;
    }
    first += 3;
  }
  neighbours_.buffer().write(0, bytes_of(slots));
  neighbours_written_ = true;
}

void GlTiles::bind_for_deposit() const {
  number_block_.bind_uniforms(0);
  moving_[static_cast<std::size_t>(parity_)].bind_texture(0);
  surface_.bind_texture(1);
  surface_.buffer().bind_storage(4);
}

std::vector<TilePlace> GlTiles::places() const {
  std::vector<TilePlace> places;
  for (const auto& entry : awake_) places.push_back(entry.first);
  return places;
}

double GlTiles::evaporated() const {
  std::vector<Column> columns(slots_ * tile::side);
  column_sums_.read(0, std::as_writable_bytes(std::span(columns)));
  double sum = 0;
  for (const Column& column : columns) sum += column.evaporated;
  return sum;
}

bool GlTiles::still() const {
  std::vector<std::byte> columns(slots_ * tile::side * sizeof(Column));
  column_sums_.read(0, columns);
  return std::ranges::none_of(awake_, [&](const auto& entry) {
    const Awake& t = entry.second;
    const std::uint16_t wet = t.since < steps_ ? wet_bits(columns, t.slot) : t.wet;
    return (wet >> tile::own & 1) != 0;
  });
}

TileCopies GlTiles::copies(const CellRect& rect) const {
  std::vector<std::pair<TilePlace, Awake>> wanted;
  for (const auto& [place, t] : awake_) {
    const int x = place.column * tile::side;
    const int y = place.row * tile::side;
    if (x < rect.left + rect.columns && x + tile::side > rect.left && y < rect.bottom + rect.rows &&
        y + tile::side > rect.bottom)
      wanted.emplace_back(place, t);
  }
  constexpr std::size_t view_planes = tile::paper_begin;
  TileCopies copies{std::vector<float>(wanted.size() * view_planes * tile::cells), {}};
  if (wanted.empty()) return copies;
  const std::array<const GlBuffer*, 3> groups = {&moving_[static_cast<std::size_t>(parity_)].buffer(),
                                                 &surface_.buffer(), &pigment_.buffer()};
  const GlBuffer staging = require(GlBuffer::make(wanted.size() * groups.size() * pair_bytes));
  for (std::size_t i = 0; i < wanted.size(); ++i)
    for (std::size_t g = 0; g < groups.size(); ++g)
      groups[g]->copy_to(staging, offset(wanted[i].second.slot, pair_bytes),
                         (i * groups.size() + g) * pair_bytes, pair_bytes);
  std::vector<float> texels(wanted.size() * groups.size() * pair_floats);
  staging.read(0, std::as_writable_bytes(std::span(texels)));
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const PlaneView view{copies.memory.data() + i * view_planes * tile::cells, tile::side, tile::cells};
    const auto pairs = [&](std::size_t g) {
      return std::span<const float>(texels).subspan((i * groups.size() + g) * pair_floats, pair_floats);
    };
    fill_planes(pairs(0), pairs(1), pairs(2), view);
    copies.tiles.push_back({wanted[i].first, view, wanted[i].second.wet});
  }
  return copies;
}

const std::map<TilePlace, FixedPigment>& GlTiles::asleep() {
  collect_sleepers();
  return asleep_;
}

void GlTiles::clear() {
  for (const auto& [place, t] : awake_) free_.push_back(t.slot);
  awake_.clear();
  asleep_.clear();
  sleepers_.clear();
  report_.reset();
  neighbours_written_ = false;
}

void GlTiles::load(const InkSnapshot::Tile& saved) {
  const TilePlace place{saved.row, saved.column};
  if (!saved.wet) {
    if (const auto found = awake_.find(place); found != awake_.end())
      put_fixed(found->second.slot, place, saved.planes);
    else
      asleep_[place] = saved.planes;
    return;
  }
  Planes planes;
  texture_.fill(place.column * tile::side, place.row * tile::side, planes.view);
  planes.lay(0, saved.planes.data(), tile::paper_begin);
  put(pour(place), texels_of(numbers_, planes.view));
}

}  // namespace fude
