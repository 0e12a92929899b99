#include "tests/lab/uinput_pen.h"

#include <fcntl.h>
#include <linux/uinput.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <initializer_list>
#include <system_error>
#include <utility>

namespace fude::lab {
namespace {

void check(bool done) {
  if (!done) throw std::system_error(errno, std::generic_category(), "uinput");
}

}  // namespace

UinputPen::UinputPen(const std::string& name) : file_(open("/dev/uinput", O_WRONLY | O_CLOEXEC)) {
  const int file = file_.get();
  check(file >= 0);
  for (const int type : {EV_KEY, EV_ABS}) check(ioctl(file, UI_SET_EVBIT, type) == 0);
  for (const int key : {BTN_TOOL_PEN, BTN_TOUCH, BTN_STYLUS}) check(ioctl(file, UI_SET_KEYBIT, key) == 0);
  for (const auto& [code, maximum] :
       {std::pair<int, int>{ABS_X, 20000}, {ABS_Y, 20000}, {ABS_PRESSURE, 2047}}) {
    uinput_abs_setup axis{};
    axis.code = static_cast<__u16>(code);
    axis.absinfo.maximum = maximum;
    axis.absinfo.resolution = code == ABS_PRESSURE ? 0 : 100;
    check(ioctl(file, UI_ABS_SETUP, &axis) == 0);
  }
  uinput_setup setup{};
  setup.id = {BUS_USB, 0x1209, 0x0002, 1};
  std::memcpy(setup.name, name.data(), std::min(name.size(), sizeof setup.name - 1));
  check(ioctl(file, UI_DEV_SETUP, &setup) == 0 && ioctl(file, UI_DEV_CREATE) == 0);
}

void UinputPen::send(std::span<const EvdevEvent> events) {
  for (const EvdevEvent& event : events) {
    input_event raw{};
    raw.type = event.type;
    raw.code = event.code;
    raw.value = event.value;
    check(write(file_.get(), &raw, sizeof raw) == static_cast<ssize_t>(sizeof raw));
  }
}

void UinputPen::move(std::int32_t x, std::int32_t y, std::int32_t pressure) {
  const EvdevEvent frame[] = {
      {EV_KEY, BTN_TOOL_PEN, 1}, {EV_KEY, BTN_TOUCH, 1},           {EV_ABS, ABS_X, x},
      {EV_ABS, ABS_Y, y},        {EV_ABS, ABS_PRESSURE, pressure}, {EV_SYN, SYN_REPORT, 0}};
  send(frame);
}

}  // namespace fude::lab
