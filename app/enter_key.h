// Enter, pressed to end work that would go on.
#pragma once

namespace fude {

class EnterKey {
 public:
  // Whether a line has come on standard input since; never again after its end. Does not wait.
  bool pressed();

 private:
  bool ended_ = false;
};

}  // namespace fude
