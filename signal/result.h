// Results: what a call gives back when the world may refuse.
// A code for the program, one line for the person, saying what to do.
// Programmer errors throw; a device that goes away is an event, not an error.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace fude {

enum class Fault {
  usage,        // the caller asked for something that has no meaning: exit status 2
  not_found,    // a file or device is not there
  exists,       // a file is there that may not be replaced
  no_access,    // permissions
  malformed,    // bytes that do not follow their format
  unsupported,  // well formed, but beyond what this build reads
  storage,      // full or failing disk
  busy,         // another program holds it
  device_gone,  // unplugged
};

struct Error {
  Fault fault;
  std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> failure(Fault fault, std::string message) {
  return tl::unexpected<Error>(Error{fault, std::move(message)});
}

}  // namespace fude
