#include "app/enter_key.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>

namespace fude {

bool EnterKey::pressed() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  while (!ended_ && poll(&input, 1, 0) > 0) {
    char text[256];
    const ssize_t length = read(STDIN_FILENO, text, sizeof text);
    if (length <= 0)
      ended_ = true;
    else if (std::find(text, text + length, '\n') != text + length)
      return true;
  }
  return false;
}

}  // namespace fude
