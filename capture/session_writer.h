// Writes a session so that nothing recorded is lost: after a power cut or a kill it opens, and at
// most what came since the last flush() is missing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "capture/database.h"
#include "capture/session.h"

namespace fude {

// One thread at a time. Every error leaves what was flushed before it in the file.
class SessionWriter {
 public:
  // Errors: exists; no_access, storage, busy.
  static Result<SessionWriter> create(const std::filesystem::path& path);

  Result<void> set(const std::string& key, const std::string& value);
  Result<void> set_sheet(const RecordedSheet& sheet);
  Result<void> add_calibration(const RecordedCalibration& calibration);
  Result<DeviceNumber> add_device(const DeviceDescription& description);
  Result<void> add_transfer(DeviceNumber device, const Transfer& transfer);

  // The order of the input among all inputs, for `applied`.
  Result<InputOrder> add_sample(DeviceNumber device, const Sample& sample);
  Result<InputOrder> add_action(const Action& action);
  Result<void> applied(InputOrder input, Step step);
  Result<void> add_receipt(const Receipt& receipt);
  Result<void> add_clock_fit(const RecordedClockFit& fit);
  Result<void> add_passed_over(const PassedOver& passed);

  // Puts what was added so far on the disk; call at least every 100 ms while recording.
  Result<void> flush();

  // Ends the session: one whole file that opens read-only.
  Result<void> close();

 private:
  struct Statements {
    Statement setting, sheet, calibration, device, axis, transfer, action, applied, receipt, clock_fit,
        passed_over;
    std::vector<Statement> samples;  // by the index of their kind
  };
  SessionWriter(Database db, Statements statements) : db_(std::move(db)), to_(std::move(statements)) {}
  Result<void> write(Statement& statement);

  Database db_;
  Statements to_;
  bool in_transaction_ = false;
  InputOrder next_input_ = 1;
};

}  // namespace fude
