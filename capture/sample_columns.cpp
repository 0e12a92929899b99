#include "capture/sample_columns.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <type_traits>

#include "capture/session_words.h"

namespace fude {
namespace {

template <class T>
struct Unwrapped {
  using type = T;
  static constexpr bool optional = false;
};
template <class T>
struct Unwrapped<std::optional<T>> {
  using type = T;
  static constexpr bool optional = true;
};

template <class T>
constexpr CellType cell_type() {
  if constexpr (std::is_same_v<T, std::string> || (std::is_enum_v<T>)) return CellType::text;
  if constexpr (std::is_integral_v<T> || std::is_same_v<T, Timestamp>) return CellType::integer;
  return std::is_same_v<T, Eigen::Matrix3d> || std::is_same_v<T, Eigen::Matrix<double, 6, 6>>
             ? CellType::text
             : CellType::real;
}

template <class T>
requires std::is_integral_v<T> Cell to_cell(T value) { return static_cast<std::int64_t>(value); }
template <class T>
requires std::is_enum_v<T> Cell to_cell(T value) { return std::string(word_for(value)); }
Cell to_cell(double value) { return value; }
Cell to_cell(const std::string& text) { return text; }
Cell to_cell(Timestamp time) { return std::int64_t{time.time_since_epoch().count()}; }
template <class Unit>
Cell to_cell(Quantity<Unit> quantity) {
  return quantity.value;
}
// Row by row, shortest form that reads back to the same bits, blanks between.
template <int n>
Cell to_cell(const Eigen::Matrix<double, n, n>& matrix) {
  std::string text;
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column) {
      std::array<char, 32> digits;
      const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), matrix(row, column)).ptr;
      if (!text.empty()) text += ' ';
      text.append(digits.data(), end);
    }
  return text;
}
template <class T>
Cell to_cell(const std::optional<T>& value) {
  return value ? to_cell(*value) : Cell{};
}

template <class T>
requires std::is_integral_v<T>
bool from_cell(const Cell& cell, T& value) {
  const auto* number = std::get_if<std::int64_t>(&cell);
  if (number == nullptr) return false;
  // Sixty-four bits are kept as they are; a smaller type must hold the number.
  if constexpr (sizeof(T) < sizeof(std::int64_t))
    if (*number < std::int64_t{std::numeric_limits<T>::min()} ||
        *number > std::int64_t{std::numeric_limits<T>::max()})
      return false;
  value = static_cast<T>(*number);
  return true;
}
template <class T>
requires std::is_enum_v<T>
bool from_cell(const Cell& cell, T& value) {
  const auto* word = std::get_if<std::string>(&cell);
  const auto known = word != nullptr ? value_for<T>(*word) : std::nullopt;
  if (known) value = *known;
  return known.has_value();
}
bool from_cell(const Cell& cell, double& value) {
  const auto* number = std::get_if<double>(&cell);
  if (number != nullptr) value = *number;
  return number != nullptr;
}
bool from_cell(const Cell& cell, std::string& text) {
  const auto* stored = std::get_if<std::string>(&cell);
  if (stored != nullptr) text = *stored;
  return stored != nullptr;
}
bool from_cell(const Cell& cell, Timestamp& time) {
  const auto* number = std::get_if<std::int64_t>(&cell);
  if (number != nullptr) time = Timestamp(Duration(*number));
  return number != nullptr;
}
template <class Unit>
bool from_cell(const Cell& cell, Quantity<Unit>& quantity) {
  return from_cell(cell, quantity.value);
}
template <int n>
bool from_cell(const Cell& cell, Eigen::Matrix<double, n, n>& matrix) {
  const auto* text = std::get_if<std::string>(&cell);
  if (text == nullptr) return false;
  const char* at = text->data();
  const char* const end = at + text->size();
  for (int i = 0; i < n * n; ++i) {
    if (i > 0 && (at == end || *at++ != ' ')) return false;
    const auto [next, error] = std::from_chars(at, end, matrix(i / n, i % n));
    if (error != std::errc{} || !std::isfinite(matrix(i / n, i % n))) return false;
    at = next;
  }
  return at == end;
}
template <class T>
bool from_cell(const Cell& cell, std::optional<T>& value) {
  value.reset();
  return std::holds_alternative<std::monostate>(cell) || from_cell(cell, value.emplace());
}

// Adds columns one by one. An access gives the field of a sample, const or not, by reference.
template <class S>
class TableOf {
 public:
  explicit TableOf(std::string stream) {
    table_.name = stream + "_sample";
    table_.stream = std::move(stream);
    table_.blank = S{};
    (*this)(
        "time_ns", "ns", [](auto& s) -> auto& { return s.time.host; })(
        "stamped_by", "", [](auto& s) -> auto& { return s.time.stamped_by; })(
        "sequence", "", [](auto& s) -> auto& { return s.time.sequence; })(
        "device_tick", "ticks", [](auto& s) -> auto& { return s.time.device_tick; });
  }

  template <class Access>
  TableOf& operator()(std::string name, std::string unit, Access access) {
    using Field = std::remove_cvref_t<decltype(access(std::declval<S&>()))>;
    using Value = typename Unwrapped<Field>::type;
    table_.columns.push_back(
        {std::move(name), std::move(unit), cell_type<Value>(), Unwrapped<Field>::optional,
         [access](const Sample& s) { return to_cell(access(std::get<S>(s))); },
         [access](Sample& s, const Cell& cell) { return from_cell(cell, access(std::get<S>(s))); }});
    return *this;
  }

  // Of the column added last.
  TableOf& since(int format) {
    table_.columns.back().since_format = format;
    return *this;
  }

  // name_x_suffix, name_y_suffix, name_z_suffix of a vector; of an optional one all three or none.
  template <class Access>
  TableOf& vector(const std::string& name, const std::string& suffix, const std::string& unit,
                  Access access) {
    using Field = std::remove_cvref_t<decltype(access(std::declval<S&>()))>;
    for (int i = 0; i < 3; ++i) {
      const std::string full = name + '_' + "xyz"[i] + (suffix.empty() ? "" : '_' + suffix);
      if constexpr (!Unwrapped<Field>::optional) {
        (*this)(
            full, unit, [ access, i ](auto& s) -> auto& { return access(s)[i]; });
      } else {
        table_.columns.push_back({full, unit, CellType::real, true,
                                  [access, i](const Sample& s) {
                                    const auto& v = access(std::get<S>(s));
                                    return v ? Cell((*v)[i]) : Cell{};
                                  },
                                  [access, i](Sample& s, const Cell& cell) {
                                    auto& v = access(std::get<S>(s));
                                    if (std::holds_alternative<std::monostate>(cell)) return i == 0 || !v;
                                    if (i == 0) v = Eigen::Vector3d::Zero();
                                    return v && from_cell(cell, (*v)[i]);
                                  }});
      }
    }
    return *this;
  }

  SampleTable take() { return std::move(table_); }

 private:
  SampleTable table_;
};

#define FIELD(path) \
  [](auto& s) -> auto& { return s.path; }

SampleTable pen() {
  return TableOf<PenSample>("pen")("tool", "", FIELD(tool))("tool_serial", "", FIELD(tool_serial))(
             "tool_id", "", FIELD(tool_id))("in_proximity", "", FIELD(in_proximity))(
             "in_contact", "", FIELD(in_contact))("x_counts", "counts", FIELD(x_counts))(
             "y_counts", "counts", FIELD(y_counts))("pressure", "of its range", FIELD(pressure))(
             "pressure_raw", "counts", FIELD(pressure_raw))("tilt_x_rad", "rad", FIELD(tilt_x))(
             "tilt_y_rad", "rad", FIELD(tilt_y))("rotation_rad", "rad", FIELD(rotation))(
             "distance", "of its range", FIELD(distance))("wheel", "of its range", FIELD(wheel))(
             "buttons", "", FIELD(buttons))("after_gap", "", FIELD(after_gap))
      .take();
}

SampleTable touch() {
  return TableOf<TouchSample>("touch")("contact", "", FIELD(contact))("down", "", FIELD(down))(
             "x_counts", "counts", FIELD(x_counts))("y_counts", "counts", FIELD(y_counts))(
             "major_counts", "counts", FIELD(major_counts))("minor_counts", "counts", FIELD(minor_counts))(
             "orientation_rad", "rad", FIELD(orientation))("pressure", "of its range", FIELD(pressure))(
             "palm", "", FIELD(palm))("after_gap", "", FIELD(after_gap))
      .take();
}

SampleTable imu() {
  return TableOf<ImuSample>("imu")
      .vector("turn", "radps", "rad/s", FIELD(turn_rate_radps))
      .vector("force", "mps2", "m/s²", FIELD(specific_force_mps2))
      .vector("field", "ut", "µT", FIELD(magnetic_field_ut))("temperature_c", "°C", FIELD(temperature_c))(
          "battery", "of its charge", FIELD(battery))("buttons", "", FIELD(buttons))(
          "saturated", "", FIELD(saturated))("valid", "", FIELD(valid))("after_gap", "", FIELD(after_gap))
      .take();
}

SampleTable pose() {
  return TableOf<PoseSample>("pose")("tool", "", FIELD(tool))("origin", "", FIELD(origin))(
             "qw", "", FIELD(tracker_from_tool.rotation.w()))("qx", "",
                                                              FIELD(tracker_from_tool.rotation.x()))(
             "qy", "", FIELD(tracker_from_tool.rotation.y()))("qz", "",
                                                              FIELD(tracker_from_tool.rotation.z()))(
             "x_m", "m", FIELD(tracker_from_tool.translation[0]))("y_m", "m",
                                                                  FIELD(tracker_from_tool.translation[1]))(
             "z_m", "m", FIELD(tracker_from_tool.translation[2]))("covariance", "rad² to m²",
                                                                  FIELD(covariance))(
             "residual_m", "m", FIELD(residual_m))("buttons", "", FIELD(buttons))("valid", "", FIELD(valid))(
             "after_gap", "", FIELD(after_gap))
      .take();
}

SampleTable position() {
  return TableOf<PositionSample>("position")("marker", "", FIELD(marker))(
             "x_m", "m", FIELD(tracker_from_marker_m[0]))("y_m", "m", FIELD(tracker_from_marker_m[1]))(
             "z_m", "m", FIELD(tracker_from_marker_m[2]))(
             "covariance_m2", "m²", FIELD(covariance_m2))("residual_m", "m", FIELD(residual_m))(
             "valid", "", FIELD(valid))("after_gap", "", FIELD(after_gap))
      .take();
}

SampleTable range() {
  TableOf<RangeSample> table("range");
  table("emitter", "", FIELD(emitter)).since(3)("receivers", "", FIELD(receivers));
  for (std::size_t i = 0; i < most_receivers; ++i)
    table(
        "flight_" + std::to_string(i) + "_s", "s", [i](auto& s) -> auto& { return s.flight_s[i]; })(
        "amplitude_" + std::to_string(i), "of full scale", [i](auto& s) -> auto& { return s.amplitude[i]; });
  return table("temperature_c", "°C", FIELD(temperature_c))("after_gap", "", FIELD(after_gap)).take();
}

SampleTable puck() {
  return TableOf<PuckSample>("puck")
      .vector("push", "", "of its range", FIELD(push))
      .vector("turn", "", "of its range", FIELD(turn))("buttons", "", FIELD(buttons))("after_gap", "",
                                                                                      FIELD(after_gap))
      .take();
}

SampleTable glove() {
  TableOf<GloveSample> table("glove");
  for (std::size_t i = 0; i < glove_fingers; ++i)
    table(
        "bend_" + std::to_string(i), "of its range", [i](auto& s) -> auto& { return s.bend[i]; });
  for (std::size_t i = 0; i < glove_lights; ++i)
    table.vector(
        "light_" + std::to_string(i), "m", "m", [i](auto& s) -> auto& { return s.lights[i]; });
  return table("buttons", "", FIELD(buttons))("after_gap", "", FIELD(after_gap)).take();
}

SampleTable haptic() {
  TableOf<HapticSample> table("haptic");
  table.vector("position", "m", "m", FIELD(position_m))
      .vector("velocity", "mps", "m/s", FIELD(velocity_mps))
      .vector("force", "n", "N", FIELD(force_n));
  for (std::size_t i = 0; i < 3; ++i)
    table(
        "encoder_" + std::to_string(i) + "_counts",
        "counts", [i](auto& s) -> auto& { return s.encoder_counts[i]; });
  return table("buttons", "", FIELD(buttons))("homed", "", FIELD(homed))("after_gap", "", FIELD(after_gap))
      .take();
}

SampleTable camera() {
  return TableOf<CameraFrame>("camera")("moment", "", FIELD(moment))("format", "", FIELD(format))(
             "width", "pixels", FIELD(width))("height", "pixels", FIELD(height))(
             "exposure_s", "s", FIELD(exposure_s))("damaged", "", FIELD(damaged))("after_gap", "",
                                                                                  FIELD(after_gap))
      .take();
}

SampleTable tick() { return TableOf<TickSample>("tick")("after_gap", "", FIELD(after_gap)).take(); }

#undef FIELD

}  // namespace

std::span<const SampleTable> sample_tables() {
  static const std::array<SampleTable, std::variant_size_v<Sample>> tables{
      pen(), touch(), imu(), pose(), position(), range(), puck(), glove(), haptic(), camera(), tick()};
  return tables;
}

const SampleTime& time_of(const Sample& sample) {
  return std::visit([](const auto& s) -> const SampleTime& { return s.time; }, sample);
}

bool valid(const Sample& sample) {
  if (const auto* frame = std::get_if<CameraFrame>(&sample)) return !frame->damaged;
  return std::visit(
      [](const auto& s) {
        if constexpr (requires { s.valid; })
          return s.valid;
        else
          return true;
      },
      sample);
}

bool after_gap(const Sample& sample) {
  return std::visit([](const auto& s) { return s.after_gap; }, sample);
}

std::string part_of(const Sample& sample) {
  if (const auto* pose = std::get_if<PoseSample>(&sample)) return pose->tool;
  if (const auto* position = std::get_if<PositionSample>(&sample)) return position->marker;
  return {};
}

}  // namespace fude
