// A whole session written again, into a file to which more is to be added.
#pragma once

#include "capture/session.h"
#include "capture/session_writer.h"

namespace fude {

// All that read_session() gives, in its order, into a new file that is not closed yet. Errors: the writer's.
Result<void> copy_session(const Session& session, SessionWriter& to);

}  // namespace fude
