// Files that a calibration leaves.
#pragma once

#include <string>

#include "signal/result.h"

namespace fude {

// Errors: exists, where there is one that may not be replaced. An empty name stands for no file.
Result<void> may_write(const std::string& name, bool force);

// Errors: storage. An empty name stands for no file.
Result<void> write_file(const std::string& name, const std::string& bytes);

}  // namespace fude
