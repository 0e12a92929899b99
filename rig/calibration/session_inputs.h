// A session's samples of all kinds in one order, pictures with their bytes.
#pragma once

#include <functional>

#include "capture/session.h"
#include "signal/result.h"
#include "signal/sample.h"
#include "signal/transfer.h"

namespace fude {

// Of a CameraFrame, the transfer with its bytes; null where they are not there, and for other kinds.
using HearInput = std::function<Result<void>(DeviceNumber, const Sample&, const Transfer* picture)>;

// In the order of arrival. Ends with the first error of `hear`.
Result<void> for_each_input(const Session& session, const HearInput& hear);

}  // namespace fude
