// The words a session file uses for enumerations.
#pragma once

#include <optional>
#include <string_view>

#include "signal/camera_frame.h"
#include "signal/device.h"
#include "signal/pen_sample.h"
#include "signal/pose.h"
#include "signal/transfer.h"

namespace fude {

// The word for a value; stable for as long as the format is.
std::string_view word_for(StampedBy by);
std::string_view word_for(Direction direction);
std::string_view word_for(TransferKind kind);
std::string_view word_for(PenTool tool);
std::string_view word_for(DeviceKind kind);
std::string_view word_for(PoseOrigin origin);
std::string_view word_for(PixelFormat format);
std::string_view word_for(ExposureMoment moment);

// The value for a word; nothing for a word that the format does not have.
template <class T>
std::optional<T> value_for(std::string_view word);

}  // namespace fude
