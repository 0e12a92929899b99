// A session's samples told apart by where they came from: one stream a device, kind and tool.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "capture/sample_columns.h"
#include "capture/session.h"

namespace fude {

struct SessionStream {
  // The device's name; "tracker/probe" where a device has several tools, "Tablet touch" where it has several
  // kinds of samples, "Tablet #2" (the device's number) where two devices have one name.
  std::string name;
  DeviceNumber device = 0;
  std::size_t kind = 0;              // of sample_tables()
  std::string part;                  // tool or marker
  std::vector<std::size_t> samples;  // where they stand in session.pens, or session.samples
};

// In the order of devices, kinds and first appearance of a tool.
std::vector<SessionStream> streams_of(const Session& session);

// The stream of that name, or the only one of that tool or kind. Errors: not_found, naming those that are
// there.
Result<SessionStream> find_stream(const Session& session, std::string_view name);

Sample sample_at(const Session& session, const SessionStream& stream, std::size_t i);

}  // namespace fude
