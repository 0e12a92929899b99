// A Linux input device as `evemu-describe` and `libinput record` print it.
#pragma once

#include <string_view>
#include <vector>

#include "signal/device.h"
#include "signal/result.h"

namespace fude {

// Reads the lines of one description in the order of the file: the `#` comments (axis values and
// resolutions stand only there in old files) and the N:, I:, P:, B: and A: lines, which rule where
// both speak. Format versions 1.0 to 1.3.
class DescriptionReader {
 public:
  // Comment lines; anything that is no part of a description is passed over.
  void comment(std::string_view line);

  // True when the line begins with a description letter, then taken.
  // Errors: malformed, without the line number.
  Result<bool> letter_line(std::string_view line);

  bool found() const { return found_; }

  // With `id` set from vendor and product; keys and axes ascending.
  // Errors: malformed when an axis has its maximum below its minimum.
  Result<DeviceDescription> finish() &&;

 private:
  AxisRange& axis(std::uint16_t code);
  Result<void> bits(std::string_view fields);
  Result<void> axis_line(std::string_view fields);

  DeviceDescription device_;
  bool found_ = false;
  std::vector<std::size_t> mask_bytes_;  // bytes of each type's bit mask read so far
  std::size_t property_bytes_ = 0;
  int comment_type_ = -1;  // event type that the comments speak of
  int comment_code_ = -1;  // and code
};

}  // namespace fude
