// A device's node in /dev, opened for one program alone.
#pragma once

#include <filesystem>
#include <string>

#include "drivers/transport/file_descriptor.h"
#include "signal/result.h"

namespace fude {

// Reading and writing, without blocking. Errors: not_found, no_access with the command that mends it,
// busy with the name of the program that has it.
Result<FileDescriptor> open_alone(const std::filesystem::path& node);

// Takes the advisory lock of a node that something else has opened. Errors: busy as above.
Result<void> hold_alone(int file, const std::filesystem::path& node);

// The one line for a node that may not be opened.
std::string access_advice(const std::filesystem::path& node);

}  // namespace fude
