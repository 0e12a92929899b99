#include "rig/sheet_snapshot.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <tuple>
#include <utility>

#include "sim/ink/tile_layout.h"

namespace fude {
namespace {

static_assert(std::endian::native == std::endian::little, "the layout is little-endian");

constexpr std::uint32_t layout = 1;
constexpr std::uint32_t most_cells = 1U << 20;  // a side
constexpr float most_in_cell = 1e6F;            // far above what any stroke leaves

class Out {
 public:
  template <class T>
  void put(const T& value) {
    put_all(std::span(&value, 1));
  }
  template <class T>
  void put_all(std::span<const T> values) {
    const auto raw = std::as_bytes(values);
    bytes.insert(bytes.end(), raw.begin(), raw.end());
  }
  std::vector<std::byte> bytes;
};

class In {
 public:
  explicit In(std::span<const std::byte> bytes) : left_(bytes) {}

  template <class T>
  bool take(T& value) {
    return take_all(std::span(&value, 1));
  }
  template <class T>
  bool take_all(std::span<T> values) {
    if (left_.size() < values.size_bytes()) return false;
    std::memcpy(values.data(), left_.data(), values.size_bytes());
    left_ = left_.subspan(values.size_bytes());
    return true;
  }
  std::size_t left() const { return left_.size(); }

 private:
  std::span<const std::byte> left_;
};

std::size_t floats_of(bool wet) {
  return (wet ? std::size_t{tile::paper_begin} : std::size_t{4}) * tile::cells;
}

// Rounding leaves amounts a little below nought.
bool is_amount(float v) { return v >= -1e-3F && v <= most_in_cell; }

Error damaged(const std::string& what) {
  return {Fault::malformed,
          "the painted sheet at the head of the session " + what + "; it cannot be painted on"};
}

}  // namespace

SheetSnapshot sheet_of(const Ink& ink) {
  SheetSnapshot sheet{ink.columns(), ink.rows(), ink.cell_mm(), ink.snapshot()};
  sheet.ink.steps = 0;
  sheet.ink.pending.clear();
  sheet.ink.ready.clear();
  return sheet;
}

std::vector<std::byte> as_bytes(const SheetSnapshot& sheet) {
  Out out;
  for (const auto number :
       {layout, static_cast<std::uint32_t>(sheet.columns), static_cast<std::uint32_t>(sheet.rows),
        static_cast<std::uint32_t>(sheet.ink.tiles.size())})
    out.put(number);
  out.put(sheet.cell_mm);
  out.put(sheet.ink.water_deposited);
  out.put(sheet.ink.water_evaporated);
  out.put(sheet.ink.pigment_deposited);
  for (const InkSnapshot::Tile& t : sheet.ink.tiles) {
    out.put(static_cast<std::int32_t>(t.column));
    out.put(static_cast<std::int32_t>(t.row));
    out.put(static_cast<std::uint32_t>(t.wet));
    out.put_all(std::span<const float>(t.planes));
  }
  return std::move(out.bytes);
}

Result<SheetSnapshot> sheet_from_bytes(std::span<const std::byte> bytes) {
  In in(bytes);
  std::uint32_t version = 0;
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  std::uint32_t tiles = 0;
  SheetSnapshot sheet;
  InkSnapshot& ink = sheet.ink;
  if (!in.take(version)) return tl::unexpected(damaged("is cut off"));
  if (version != layout)
    return failure(Fault::unsupported, "the session begins on a sheet of a newer fude; use that");
  if (!in.take(columns) || !in.take(rows) || !in.take(tiles) || !in.take(sheet.cell_mm) ||
      !in.take(ink.water_deposited) || !in.take(ink.water_evaporated) || !in.take(ink.pigment_deposited))
    return tl::unexpected(damaged("is cut off"));
  bool finite = std::isfinite(sheet.cell_mm) && std::isfinite(ink.water_deposited) &&
                std::isfinite(ink.water_evaporated);
  for (const double p : ink.pigment_deposited) finite = finite && std::isfinite(p);
  if (!finite || columns == 0 || rows == 0 || columns > most_cells || rows > most_cells)
    return tl::unexpected(damaged("has impossible sizes"));
  sheet.columns = static_cast<int>(columns);
  sheet.rows = static_cast<int>(rows);

  const std::int32_t across = (sheet.columns + tile::side - 1) / tile::side;
  const std::int32_t up = (sheet.rows + tile::side - 1) / tile::side;
  for (std::uint32_t i = 0; i < tiles; ++i) {
    InkSnapshot::Tile t{};
    std::uint32_t wet = 0;
    if (!in.take(t.column) || !in.take(t.row) || !in.take(wet)) return tl::unexpected(damaged("is cut off"));
    if (t.column < 0 || t.row < 0 || t.column >= across || t.row >= up || wet > 1)
      return tl::unexpected(damaged("holds ink off the sheet"));
    if (!ink.tiles.empty() &&
        std::tie(t.row, t.column) <= std::tie(ink.tiles.back().row, ink.tiles.back().column))
      return tl::unexpected(damaged("holds a place twice"));
    t.wet = wet == 1;
    if (in.left() < floats_of(t.wet) * sizeof(float)) return tl::unexpected(damaged("is cut off"));
    t.planes.resize(floats_of(t.wet));
    in.take_all(std::span(t.planes));
    for (const float v : t.planes)
      if (!is_amount(v)) return tl::unexpected(damaged("holds what is no amount of ink or water"));
    ink.tiles.push_back(std::move(t));
  }
  if (in.left() != 0) return tl::unexpected(damaged("goes on after its end"));
  return sheet;
}

Result<void> lay_sheet(const SheetSnapshot& sheet, Ink& ink) {
  if (sheet.columns != ink.columns() || sheet.rows != ink.rows() || sheet.cell_mm != ink.cell_mm())
    return failure(Fault::usage, "the session begins on a painted sheet of " + std::to_string(sheet.columns) +
                                     " x " + std::to_string(sheet.rows) +
                                     " cells; it cannot be painted with another --size-mm or --cell-mm");
  ink.restore(sheet.ink);
  return {};
}

}  // namespace fude
