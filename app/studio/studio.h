// The studio: a window over a live painting. It shows what the rig gives and passes on what the painter
// does; nothing in it computes ink or brush.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "app/studio/script.h"
#include "capture/session.h"
#include "rig/replay.h"
#include "signal/result.h"

namespace fude {

struct StudioSetup {
  ReplaySettings settings;
  std::optional<Session> played;       // is played as if its hand were here
  std::optional<SheetSnapshot> sheet;  // what is painted on; none: dry white paper
  std::vector<ScriptedEvent> script;   // injected; the window closes at its end only by `quit`
  std::filesystem::path out;           // the session to record; empty: none
  std::filesystem::path picture;  // the sheet at the end, as a replay of the session paints it; empty: none
  bool overwrite = false;
};

// Until the window is closed. Errors: unsupported where there is no display or no OpenGL 3.3, those of the
// painting, of the recorder and of the pictures.
Result<void> run_studio(const StudioSetup& setup);

}  // namespace fude
