#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "app/commands.h"
#include "capture/session.h"
#include "rig/session_summary.h"

namespace fude {
namespace {

nlohmann::ordered_json as_json(const SessionSummary& summary) {
  nlohmann::ordered_json streams = nlohmann::ordered_json::array();
  for (const StreamSummary& s : summary.streams)
    streams.push_back({{"name", s.name},
                       {"kind", s.kind},
                       {"samples", s.samples},
                       {"rate_hz", s.rate_hz},
                       {"gaps", s.gaps},
                       {"start_s", s.start_s},
                       {"end_s", s.end_s},
                       {"units", s.units}});
  return {{"streams", streams},
          {"duration_s", summary.duration_s},
          {"calibration", summary.calibration},
          {"complete", summary.complete}};
}

void print(const SessionSummary& summary) {
  for (const StreamSummary& s : summary.streams)
    std::printf("%-8s %-32s %8lld samples %7.1f Hz %4lld gaps  %8.3f s to %8.3f s  %s\n", s.kind.c_str(),
                s.name.c_str(), static_cast<long long>(s.samples), s.rate_hz, static_cast<long long>(s.gaps),
                s.start_s, s.end_s, s.units.c_str());
  for (const std::string& name : summary.calibration) std::printf("calibrated: %s\n", name.c_str());
  std::printf("%.3f s in all; %s\n", summary.duration_s,
              summary.complete ? "complete" : "not closed in good order, all that was written is here");
}

}  // namespace

void add_info(CLI::App& app, int& status) {
  struct Options {
    std::string session;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("info", "says what a session holds");
  command->add_option("SESSION", options->session, "a .fude session")->required();
  command->add_flag("--json", options->json, "as JSON");
  command->callback([options, &status] {
    const auto session = read_session(options->session);
    if (!session) {
      status = report(session.error());
      return;
    }
    const SessionSummary summary = summarise(*session);
    if (options->json)
      std::printf("%s\n",
                  as_json(summary).dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
    else
      print(summary);
  });
}

}  // namespace fude
