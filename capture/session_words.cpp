#include "capture/session_words.h"

#include <array>
#include <utility>

namespace fude {
namespace {

template <class T>
struct Words;

template <>
struct Words<StampedBy> {
  static constexpr std::array<std::pair<StampedBy, std::string_view>, 3> table{
      {{StampedBy::kernel, "kernel"}, {StampedBy::arrival, "arrival"}, {StampedBy::recording, "recording"}}};
};
template <>
struct Words<Direction> {
  static constexpr std::array<std::pair<Direction, std::string_view>, 2> table{
      {{Direction::from_device, "from"}, {Direction::to_device, "to"}}};
};
template <>
struct Words<TransferKind> {
  static constexpr std::array<std::pair<TransferKind, std::string_view>, 13> table{
      {{TransferKind::evdev_frame, "evdev"},
       {TransferKind::hid_report, "hid"},
       {TransferKind::hid_feature, "hid_feature"},
       {TransferKind::hid_ask, "hid_ask"},
       {TransferKind::usb_control, "usb_control"},
       {TransferKind::usb_bulk, "usb_bulk"},
       {TransferKind::usb_interrupt, "usb_interrupt"},
       {TransferKind::serial, "serial"},
       {TransferKind::message, "message"},
       {TransferKind::picture, "picture"},
       {TransferKind::plugged, "plugged"},
       {TransferKind::unplugged, "unplugged"},
       {TransferKind::suspended, "suspended"}}};
};
template <>
struct Words<PenTool> {
  static constexpr std::array<std::pair<PenTool, std::string_view>, 6> table{
      {{PenTool::none, "none"},
       {PenTool::pen, "pen"},
       {PenTool::rubber, "rubber"},
       {PenTool::brush, "brush"},
       {PenTool::pencil, "pencil"},
       {PenTool::airbrush, "airbrush"}}};
};
template <>
struct Words<DeviceKind> {
  static constexpr std::array<std::pair<DeviceKind, std::string_view>, 12> table{
      {{DeviceKind::pen_tablet, "tablet"},
       {DeviceKind::mouse, "mouse"},
       {DeviceKind::touch, "touch"},
       {DeviceKind::tracker, "tracker"},
       {DeviceKind::imu, "imu"},
       {DeviceKind::ultrasonic, "ultrasonic"},
       {DeviceKind::puck, "puck"},
       {DeviceKind::glove, "glove"},
       {DeviceKind::haptic, "haptic"},
       {DeviceKind::camera, "camera"},
       {DeviceKind::clock, "clock"},
       {DeviceKind::other, "other"}}};
};
template <>
struct Words<PoseOrigin> {
  static constexpr std::array<std::pair<PoseOrigin, std::string_view>, 4> table{
      {{PoseOrigin::none, "none"},
       {PoseOrigin::measured, "measured"},
       {PoseOrigin::interpolated, "interpolated"},
       {PoseOrigin::predicted, "predicted"}}};
};
template <>
struct Words<PixelFormat> {
  static constexpr std::array<std::pair<PixelFormat, std::string_view>, 4> table{
      {{PixelFormat::grey, "grey"},
       {PixelFormat::yuyv, "yuyv"},
       {PixelFormat::mjpeg, "mjpeg"},
       {PixelFormat::png, "png"}}};
};
template <>
struct Words<ExposureMoment> {
  static constexpr std::array<std::pair<ExposureMoment, std::string_view>, 3> table{
      {{ExposureMoment::unknown, "unknown"}, {ExposureMoment::start, "start"}, {ExposureMoment::end, "end"}}};
};

template <class T>
std::string_view find_word(T value) {
  for (const auto& [v, word] : Words<T>::table)
    if (v == value) return word;
  return "none";
}

}  // namespace

std::string_view word_for(StampedBy by) { return find_word(by); }
std::string_view word_for(Direction direction) { return find_word(direction); }
std::string_view word_for(TransferKind kind) { return find_word(kind); }
std::string_view word_for(PenTool tool) { return find_word(tool); }
std::string_view word_for(DeviceKind kind) { return find_word(kind); }
std::string_view word_for(PoseOrigin origin) { return find_word(origin); }
std::string_view word_for(PixelFormat format) { return find_word(format); }
std::string_view word_for(ExposureMoment moment) { return find_word(moment); }

template <class T>
std::optional<T> value_for(std::string_view word) {
  for (const auto& [value, w] : Words<T>::table)
    if (w == word) return value;
  return std::nullopt;
}
template std::optional<StampedBy> value_for<StampedBy>(std::string_view);
template std::optional<Direction> value_for<Direction>(std::string_view);
template std::optional<TransferKind> value_for<TransferKind>(std::string_view);
template std::optional<PenTool> value_for<PenTool>(std::string_view);
template std::optional<DeviceKind> value_for<DeviceKind>(std::string_view);
template std::optional<PoseOrigin> value_for<PoseOrigin>(std::string_view);
template std::optional<PixelFormat> value_for<PixelFormat>(std::string_view);
template std::optional<ExposureMoment> value_for<ExposureMoment>(std::string_view);

}  // namespace fude
