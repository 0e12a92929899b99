#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "app/commands.h"
#include "rig/doctor.h"

namespace fude {
namespace {

const char* word(Standing standing) {
  switch (standing) {
    case Standing::good:
      return "ok";
    case Standing::lacking:
      return "missing";
    case Standing::hinders:
      return "hinders";
  }
  return "";
}

nlohmann::ordered_json as_json(const std::vector<Finding>& findings) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Finding& finding : findings)
    list.push_back({{"subject", finding.subject},
                    {"standing", word(finding.standing)},
                    {"says", finding.says},
                    {"command", finding.command}});
  return {{"can_paint", can_paint(findings)}, {"findings", list}};
}

int examine(const std::string& folder, bool json) {
  const std::vector<Finding> findings = diagnose(examine_machine(folder));
  if (json) {
    std::printf("%s\n",
                as_json(findings).dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  } else {
    for (const Finding& finding : findings)
      std::printf("%-7s  %s: %s%s\n", word(finding.standing), finding.subject.c_str(), finding.says.c_str(),
                  finding.command.empty() ? "" : ("; run `" + finding.command + "`").c_str());
    std::printf(can_paint(findings) ? "one can paint here\n"
                                    : "no painting here before what hinders is mended\n");
  }
  return can_paint(findings) ? 0 : 1;
}

}  // namespace

void add_doctor(CLI::App& app, int& status) {
  struct Options {
    std::string folder = ".";
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("doctor", "says what is missing here, and the command that mends it");
  command->add_option("--folder", options->folder, "where sessions are to go");
  command->add_flag("--json", options->json, "as JSON");
  command->callback([options, &status] { status = examine(options->folder, options->json); });
}

}  // namespace fude
