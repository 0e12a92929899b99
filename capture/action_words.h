// The verb and the JSON by which a session file keeps what the painter did.
#pragma once

#include <string>

#include "signal/action.h"
#include "signal/result.h"

namespace fude {

struct ActionWords {
  std::string verb;
  std::string arguments;  // a JSON object
};
ActionWords words_for(const Action& action);

// Errors: malformed, naming the verb.
Result<Action> action_from(Timestamp time, const std::string& verb, const std::string& arguments);

}  // namespace fude
