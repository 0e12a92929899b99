// A session as a value: what was read, what it was taken for, what the painter did, and when each
// was applied. The file is described in docs/session-format.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "signal/action.h"
#include "signal/clock_fit.h"
#include "signal/device.h"
#include "signal/result.h"
#include "signal/sample.h"
#include "signal/transfer.h"

namespace fude {

// Numbers a device within one session; 1 and up.
using DeviceNumber = std::int64_t;

// Inputs of all kinds share one order of arrival.
using InputOrder = std::int64_t;

// Counts ink steps from the start of the painting.
using Step = std::int64_t;

struct RecordedDevice {
  DeviceNumber number = 0;
  DeviceDescription description;
};

struct RecordedTransfer {
  DeviceNumber device = 0;
  Transfer transfer;
};

struct RecordedPen {
  InputOrder order = 0;
  DeviceNumber device = 0;
  PenSample sample;
  std::optional<Step> applied;  // where the painting ran live
};

// Of every other kind of device.
struct RecordedSample {
  DeviceNumber device = 0;
  Sample sample;
  InputOrder order = 0;
};

struct RecordedAction {
  InputOrder order = 0;
  Action action;
  std::optional<Step> applied;
};

// What a stream was asked for and gave, written when recording ends.
struct Receipt {
  DeviceNumber device = 0;
  std::int64_t expected = 0;
  std::int64_t received = 0;
  std::int64_t dropped = 0;
};

// How one run of a device's clock lies on the host's; `part` as in part_of (capture/sample_columns.h).
struct RecordedClockFit {
  DeviceNumber device = 0;
  std::string part;
  ClockLine line;
};

// What an import could not understand, and how often.
struct PassedOver {
  DeviceNumber device = 0;
  std::string what;
  std::int64_t count = 0;
};

struct RecordedCalibration {
  std::string name;
  std::string toml;
};

// The sheet that a painting began on; its bytes are the rig's (docs/session-format.md).
struct RecordedSheet {
  Step step = 0;
  std::vector<std::byte> state;
};

struct Session {
  std::vector<RecordedDevice> devices;
  std::vector<RecordedTransfer> transfers;
  std::vector<RecordedPen> pens;
  std::vector<RecordedSample> samples;  // all kinds but pens, in their order
  std::vector<RecordedAction> actions;
  std::vector<Receipt> receipts;
  std::vector<RecordedClockFit> clock_fits;
  std::vector<PassedOver> passed_over;
  std::vector<RecordedCalibration> calibrations;
  std::map<std::string, std::string>
      settings;  // brush, paper, sheet size … as they were when recording began
  std::optional<RecordedSheet> sheet;
  bool complete = false;  // closed in good order
};

// Reads a whole session. One that was not closed is repaired first and reads as not complete.
// Errors: not_found, no_access, busy, malformed (no session, damaged, hostile), unsupported (newer).
// Formats 1 to 4.
Result<Session> read_session(const std::filesystem::path& path);

}  // namespace fude
