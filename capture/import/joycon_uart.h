// What went over a Joy-Con's rail as a logic analyser saw it: one packet a line, bytes as 0x19 0x81 …
#pragma once

#include <string_view>

#include "capture/import/recording.h"
#include "signal/result.h"

namespace fude {

bool looks_like_joycon_uart(std::string_view text);

// Each packet is kept whole as a `serial` transfer. The file has no times: they are those of the timer in
// full reports (5 ms a count, its wraps undone), from 0; packets without one have the time of the packet
// before. Lines that are no bytes are passed over and counted; packets that the rail's checksum refuses are
// the decoder's to count. Errors: malformed where no line is a packet.
Result<RawRecording> import_joycon_uart(std::string_view text);

}  // namespace fude
