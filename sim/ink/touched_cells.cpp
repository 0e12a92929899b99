#include "sim/ink/touched_cells.h"

#include <algorithm>
#include <cmath>

namespace fude {
namespace {

// The lattice cells that one interval of the map overlaps, and by how much of a cell.
struct Overlap {
  int first;
  int last;
  double low;
  double high;

  double share(int cell) const {
    return std::min(high, cell + 1.0) - std::max(low, static_cast<double>(cell));
  }
};

// An edge that lies on the lattice but for rounding does lie on it: else each cell of a map that fits the
// lattice would touch nine.
double on_lattice(double cells) {
  const double nearest = std::round(cells);
  return std::abs(cells - nearest) < 1e-6 ? nearest : cells;
}

Overlap overlap(double low_mm, double size_mm, double cell_mm, int cells) {
  const double low = std::max(on_lattice(low_mm / cell_mm), 0.0);
  const double high = std::min(on_lattice((low_mm + size_mm) / cell_mm), static_cast<double>(cells));
  if (!(low < high)) return {0, -1, 0, 0};
  return {static_cast<int>(low), static_cast<int>(std::ceil(high)) - 1, low, high};
}

float positive(float x, float most) { return x > 0 && std::isfinite(x) ? std::min(x, most) : 0; }

struct Piece {
  std::uint16_t patch;
  double fresh;
  double contact;
};

// Counting sort by lattice cell: a map of ten thousand cells comes two hundred times a second.
class Buckets {
 public:
  Buckets(Overlap columns, Overlap rows)
      : columns_(columns), width_(columns.last - columns.first + 1), begin_(cells(rows) + 1, 0) {
    first_row_ = rows.first;
  }

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row - first_row_) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(column - columns_.first);
  }
  void count(int column, int row) { ++begin_[index(column, row) + 1]; }
  void allocate() {
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    next_ = begin_;
    pieces_.resize(begin_.back());
  }
  void put(int column, int row, const Piece& piece) { pieces_[next_[index(column, row)]++] = piece; }

  std::vector<TouchedCell> merged() {
    std::vector<TouchedCell> touched;
    for (std::size_t i = 0; i + 1 < begin_.size(); ++i) {
      const auto first = pieces_.begin() + static_cast<std::ptrdiff_t>(begin_[i]);
      const auto last = pieces_.begin() + static_cast<std::ptrdiff_t>(begin_[i + 1]);
      if (last - first > 1)
        std::stable_sort(first, last, [](const Piece& a, const Piece& b) { return a.patch < b.patch; });
      for (auto p = first; p != last;) {
        Piece sum{p->patch, 0, 0};
        for (; p != last && p->patch == sum.patch; ++p) {
          sum.fresh += p->fresh;
          sum.contact += p->contact;
        }
        touched.push_back({columns_.first + static_cast<int>(i) % width_,
                           first_row_ + static_cast<int>(i) / width_, sum.patch,
                           static_cast<float>(sum.fresh), static_cast<float>(sum.contact)});
      }
    }
    return touched;
  }

 private:
  std::size_t cells(Overlap rows) const {
    return static_cast<std::size_t>(std::max(width_, 0)) *
           static_cast<std::size_t>(std::max(rows.last - rows.first + 1, 0));
  }

  Overlap columns_;
  int width_;
  int first_row_ = 0;
  std::vector<std::size_t> begin_;
  std::vector<std::size_t> next_;
  std::vector<Piece> pieces_;
};

}  // namespace

std::vector<TouchedCell> touched_cells(const Deposit& deposit, double cell_mm, int columns, int rows) {
  const FootprintMap& map = deposit.map;
  const std::size_t size =
      static_cast<std::size_t>(std::max(map.columns, 0)) * static_cast<std::size_t>(std::max(map.rows, 0));
  if (size == 0 || map.fresh.size() != size || map.contact_s.size() != size || map.patch.size() != size ||
      !(map.cell_mm > 0))
    return {};
  // A little wider than the map: the edges of its last cells are rounded otherwise than its own.
  const double rim = 2e-6 * cell_mm;
  const Overlap across = overlap(map.left_mm - rim, map.columns * map.cell_mm + 2 * rim, cell_mm, columns);
  const Overlap up = overlap(map.bottom_mm - rim, map.rows * map.cell_mm + 2 * rim, cell_mm, rows);
  if (across.last < across.first || up.last < up.first) return {};
  std::vector<Overlap> of_column;
  for (int x = 0; x < map.columns; ++x)
    of_column.push_back(overlap(map.left_mm + x * map.cell_mm, map.cell_mm, cell_mm, columns));

  const auto for_each_piece = [&](const auto& take) {
    for (int y = 0; y < map.rows; ++y) {
      const Overlap v = overlap(map.bottom_mm + y * map.cell_mm, map.cell_mm, cell_mm, rows);
      for (int x = 0; x < map.columns; ++x) {
        const std::size_t i =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(map.columns) + static_cast<std::size_t>(x);
        const float fresh = positive(map.fresh[i], 1.0F);
        const float contact = positive(map.contact_s[i], 1e6F);
        if ((fresh == 0 && contact == 0) || map.patch[i] >= deposit.patches.size()) continue;
        const Overlap& u = of_column[static_cast<std::size_t>(x)];
        for (int row = v.first; row <= v.last; ++row)
          for (int column = u.first; column <= u.last; ++column) {
            const double share = u.share(column) * v.share(row);
            if (share > 0)
              take(column, row,
                   Piece{map.patch[i], share * static_cast<double>(fresh),
                         share * static_cast<double>(contact)});
          }
      }
    }
  };
  Buckets buckets(across, up);
  for_each_piece([&](int column, int row, const Piece&) { buckets.count(column, row); });
  buckets.allocate();
  for_each_piece([&](int column, int row, const Piece& piece) { buckets.put(column, row, piece); });
  return buckets.merged();
}

}  // namespace fude
