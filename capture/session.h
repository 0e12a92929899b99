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
#include "signal/device.h"
#include "signal/pen_sample.h"
#include "signal/result.h"
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
  std::vector<RecordedAction> actions;
  std::vector<Receipt> receipts;
  std::vector<RecordedCalibration> calibrations;
  std::map<std::string, std::string>
      settings;  // brush, paper, sheet size … as they were when recording began
  std::optional<RecordedSheet> sheet;
  bool complete = false;  // closed in good order
};

// Reads a whole session. One that was not closed is repaired first and reads as not complete.
// Errors: not_found, no_access, busy, malformed (no session, damaged, hostile), unsupported (newer).
Result<Session> read_session(const std::filesystem::path& path);

}  // namespace fude
