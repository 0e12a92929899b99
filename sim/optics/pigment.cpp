#include "sim/optics/pigment.h"

#include <algorithm>
#include <string>

namespace fude {
namespace {

constexpr Pigment rows[] = {
#define FUDE_PIGMENT(name, kr, kg, kb, sr, sg, sb) {name, {kr, kg, kb}, {sr, sg, sb}},
#include "sim/optics/pigments.inl"
#undef FUDE_PIGMENT
};

}  // namespace

std::span<const Pigment> pigments() { return rows; }

Result<Pigment> find_pigment(std::string_view name) {
  const auto found = std::ranges::find(rows, name, &Pigment::name);
  if (found != std::end(rows)) return *found;
  std::string known;
  for (const Pigment& row : rows) known += (known.empty() ? "" : ", ") + std::string(row.name);
  return failure(Fault::not_found, "no pigment called '" + std::string(name) + "': choose one of " + known);
}

}  // namespace fude
