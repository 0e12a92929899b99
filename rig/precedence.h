// Which thread comes first where the ink's keep every processor busy.
#pragma once

namespace fude {

// A greater one comes before a smaller, and all before every other thread.
enum class Precedence : int {
  brush = 1,  // less than a millisecond at a time
  arm = 2,    // some tens of microseconds, each millisecond
};

// For the calling thread, not for those that it starts. False where the user may not ask for it
// (`ulimit -r`, as for sound); the thread then takes its turn with the others.
bool ask_for(Precedence precedence);

}  // namespace fude
