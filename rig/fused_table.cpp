#include "rig/fused_table.h"

#include <cstdio>
#include <cstdlib>

namespace fude {
namespace {

const char* name_of(FusionState state) {
  return state == FusionState::ok ? "OK" : state == FusionState::predicted ? "PREDICTED" : "LOST";
}

}  // namespace

std::string csv_of(const FusedSession& fused) {
  std::string text = "t_s,x_m,y_m,z_m,qw,qx,qy,qz,var_0,var_1,var_2,var_3,var_4,var_5,state\n";
  char field[40];
  const auto number = [&](double value, const char* format) {
    std::snprintf(field, sizeof field, format, value);
    text += ',';
    text += field;
  };
  for (const FusedRow& row : fused.rows) {
    const auto ns = row.time.time_since_epoch().count();
    std::snprintf(field, sizeof field, "%s%lld.%09lld", ns < 0 ? "-" : "",
                  static_cast<long long>(std::abs(ns) / 1'000'000'000),
                  static_cast<long long>(std::abs(ns) % 1'000'000'000));
    text += field;
    if (row.position_m)
      for (int i = 0; i < 3; ++i) number((*row.position_m)[i], "%.7f");
    else
      text += ",,,";
    const auto& q = row.world_from_sensor;
    if (q)
      for (const double part : {q->w(), q->x(), q->y(), q->z()}) number(part, "%.9f");
    else
      text += ",,,,";
    for (int i = 0; i < 6; ++i) {
      if (i < 3 ? row.position_m.has_value() : q.has_value())
        number(row.variance[i], "%.6g");
      else
        text += ',';
    }
    text += ',';
    text += name_of(row.state);
    text += '\n';
  }
  return text;
}

}  // namespace fude
