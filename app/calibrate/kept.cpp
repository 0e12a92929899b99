// The calibrations of this rig that are kept: what they are, and the one before.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/calibrate/procedures.h"
#include "app/commands.h"
#include "rig/calibration/calibration_store.h"

namespace fude {
namespace {

using Json = nlohmann::ordered_json;

Json as_json(const KeptCalibration& kept) {
  const CalibrationReport& r = kept.calibration.report;
  return {{"procedure", r.procedure},
          {"version", kept.version},
          {"current", kept.current},
          {"devices", r.devices},
          {"tool", r.tool},
          {"reference", r.reference},
          {"date", r.date},
          {"rms", r.rms},
          {"unit", r.unit},
          {"warnings", r.warnings},
          {"file", kept.file.string()}};
}

void print(const KeptCalibration& kept) {
  const CalibrationReport& r = kept.calibration.report;
  std::string with;
  for (const std::string& device : r.devices) with += (with.empty() ? "" : " ") + device;
  if (!r.tool.empty()) with += " " + r.tool;
  if (!r.reference.empty()) with += " on " + r.reference;
  std::printf("%c %-13s %3d  %-20s  rms %.3f %s  %s\n", kept.current ? '*' : ' ', r.procedure.c_str(),
              kept.version, r.date.c_str(), r.rms, r.unit.c_str(), with.c_str());
}

Result<void> list(bool json) {
  const auto store = CalibrationStore::of_user();
  if (!store) return tl::unexpected(store.error());
  std::vector<std::string> warnings;
  const auto all = store->all(warnings);
  for (const std::string& warning : warnings) std::fprintf(stderr, "fude: %s\n", warning.c_str());
  if (json) {
    Json rows = Json::array();
    for (const KeptCalibration& kept : all) rows.push_back(as_json(kept));
    std::printf("%s\n", rows.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    return {};
  }
  for (const KeptCalibration& kept : all) print(kept);
  if (all.empty()) std::printf("no calibration is kept; `fude calibrate pivot` makes the first\n");
  return {};
}

struct RollBack {
  std::string procedure, device, tool;
};

Result<void> roll_back(const RollBack& wish) {
  const auto store = CalibrationStore::of_user();
  if (!store) return tl::unexpected(store.error());
  const auto kept = store->roll_back(wish.procedure, wish.device, wish.tool);
  if (!kept) return tl::unexpected(kept.error());
  print(*kept);
  return {};
}

}  // namespace

void add_calibrate_list(CLI::App& calibrate, int& status) {
  auto json = std::make_shared<bool>(false);
  CLI::App* command =
      calibrate.add_subcommand("list", "the calibrations that are kept; * marks those in use");
  command->add_flag("--json", *json, "as JSON");
  command->callback([json, &status] {
    if (const auto done = list(*json); !done) status = report(done.error());
  });
}

void add_calibrate_rollback(CLI::App& calibrate, int& status) {
  auto wish = std::make_shared<RollBack>();
  CLI::App* command =
      calibrate.add_subcommand("rollback", "takes the version before again; nothing is deleted");
  command->add_option("WHAT", wish->procedure, "the procedure")->required();
  command->add_option("--device", wish->device, "vendor:product:serial, where several are kept");
  command->add_option("--tool", wish->tool, "likewise the tool");
  command->callback([wish, &status] {
    if (const auto done = roll_back(*wish); !done) status = report(done.error());
  });
}

}  // namespace fude
