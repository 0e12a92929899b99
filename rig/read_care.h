// How a performance says what is done to the ink in the brush (docs/performances.md).
#pragma once

#include <toml++/toml.h>

#include <optional>
#include <vector>

#include "rig/paint_box.h"
#include "signal/action.h"

namespace fude {

// The strengths of `{ink, glue, PIGMENT…}`. None: malformed.
std::optional<Concentrations> ink_from(const toml::table& table, const PaintBox& box);

// Of `{wetness, ink, glue, PIGMENT…}`, or of `{stops = [{at, …}…], far_stops = […]}`. None: malformed.
std::optional<BrushCare> load_from(const toml::table& table, const PaintBox& box);

// Of `[{rinse = 2}, {wipe = 0.5}, {dip = …, depth_mm, seconds}, {blot = 0.5, side}, {roll = 1}, {load = …},
// {reshape = true}]`, in their order. None: malformed.
std::optional<std::vector<decltype(Action::what)>> cares_from(const toml::array& rows, const PaintBox& box);

}  // namespace fude
