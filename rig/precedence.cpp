#include "rig/precedence.h"

#include <pthread.h>
#include <sched.h>

namespace fude {

// Some kernels let a busy thread go on until the next tick, 4 ms away, where nobody has asked to come first.
bool ask_for(Precedence precedence) {
  const sched_param wish{.sched_priority = static_cast<int>(precedence)};
  return pthread_setschedparam(pthread_self(), SCHED_RR | SCHED_RESET_ON_FORK, &wish) == 0;
}

}  // namespace fude
