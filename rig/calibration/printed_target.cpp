#include "rig/calibration/printed_target.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "vision/printed_board.h"

namespace fude {
namespace {

constexpr double free_mm = 8;    // of ink: printers do not reach the edge
constexpr double strip_mm = 14;  // below the board, for ruler and text
constexpr double ruler_mm = 100;

struct PageSize {
  const char* name;
  Eigen::Vector2d size_mm;  // upright
};
const PageSize pages[] = {{"a4", {210, 297}}, {"a3", {297, 420}}, {"letter", {215.9, 279.4}}};

Eigen::Vector2d room_on(const Eigen::Vector2d& page_mm) {
  return page_mm - Eigen::Vector2d(2 * free_mm, 2 * free_mm + strip_mm);
}

std::string shortest(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

// A line with a tick each 10 mm, longer at both ends: the distance of the ends' outer edges is 100 mm.
void add_ruler(PrintedPage& page, const Eigen::Vector2d& corner_mm) {
  constexpr double line_mm = 0.3, tick_mm = 2, end_mm = 4;
  page.black.push_back({corner_mm + Eigen::Vector2d(line_mm, 0), {ruler_mm - 2 * line_mm, line_mm}});
  for (int i = 0; i <= 10; ++i) {
    const bool end = i == 0 || i == 10;
    const double at = i == 0 ? 0 : i == 10 ? ruler_mm - line_mm : 10.0 * i - line_mm / 2;
    const Eigen::Vector2d below(at, end ? 0 : line_mm);
    page.black.push_back({corner_mm + below, {line_mm, (end ? end_mm : tick_mm) - below.y()}});
  }
}

std::string named(const Board& board) {
  const std::string size = std::to_string(board.columns) + " X " + std::to_string(board.rows);
  const std::string square = " OF " + shortest(1e3 * board.square_m) + " MM";
  if (board.kind == BoardKind::chessboard) return "CHESSBOARD " + size + " INNER CORNERS SQUARES" + square;
  return "CHARUCO " + size + " SQUARES" + square + " MARKERS OF " + shortest(1e3 * board.marker_m) + " MM " +
         board.dictionary;
}

}  // namespace

Result<PrintedPage> printed_target(const Board& board, const std::string& page_name) {
  const auto areas = black_areas(board);
  if (!areas) return tl::unexpected(areas.error());
  const auto known =
      std::ranges::find(pages, page_name, [](const PageSize& p) { return std::string(p.name); });
  if (known == std::end(pages))
    return failure(Fault::usage, "there is no page '" + page_name + "'; choose a4, a3 or letter");
  const Eigen::Vector2d size_mm = 1e3 * printed_size_m(board);
  std::optional<Eigen::Vector2d> sheet_mm;
  double largest = 0;  // of what would fit, over what was asked for
  for (const Eigen::Vector2d& way : {known->size_mm, Eigen::Vector2d(known->size_mm.reverse())}) {
    const double scale = room_on(way).cwiseQuotient(size_mm).minCoeff();
    if (!sheet_mm && scale >= 1) sheet_mm = way;
    largest = std::max(largest, scale);
  }
  if (!sheet_mm)
    return failure(Fault::usage, "the board is " + shortest(size_mm.x()) + " x " + shortest(size_mm.y()) +
                                     " mm and does not fit on " + page_name + ": its squares may be " +
                                     shortest(std::floor(largest * 1e4 * board.square_m) / 10) +
                                     " mm there; or choose a larger --page or fewer --columns and --rows");
  PrintedPage page{*sheet_mm, {}};
  const Eigen::Vector2d corner_mm(std::round((sheet_mm->x() - size_mm.x()) / 2), free_mm);
  for (const BlackArea& area : *areas)
    page.black.push_back({corner_mm + 1e3 * area.corner_m, 1e3 * area.size_m});
  const Eigen::Vector2d strip(free_mm, sheet_mm->y() - free_mm - strip_mm + 4);
  add_ruler(page, strip);
  constexpr double letter_mm = 1.75;
  for (const auto& [text, down] :
       {std::pair(std::string("100 MM. PRINT AT 100 PER CENT AND MEASURE THIS LINE"), 4.8),
        std::pair(named(board), 7.6)})
    for (PrintedArea& area : lettering(text, strip + Eigen::Vector2d(1, down), letter_mm))
      page.black.push_back(std::move(area));
  return page;
}

}  // namespace fude
