#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/numbers_option.h"
#include "drivers/transport/waker.h"
#include "rig/named_device.h"
#include "rig/pose_relay.h"

namespace fude {
namespace {

constexpr Duration attendance = std::chrono::milliseconds(100);

struct Options {
  PoseServers::Doors doors;
  std::vector<std::string> named;
  bool fuse = false;
  Eigen::Vector3d up{0, 0, 1};
  double predict_ms = 0;
  double seconds = 0;  // 0: until Ctrl-C
};

int serve(const Options& options) {
  InterruptWatch interrupt;  // before any thread starts
  PoseRelay::Wish wish{.doors = options.doors, .named = {}, .fused_with_up = std::nullopt, .fused_ahead = {}};
  if (options.fuse) {
    wish.fused_with_up = options.up;
    wish.fused_ahead =
        std::chrono::round<Duration>(std::chrono::duration<double, std::milli>(options.predict_ms));
    if (!(wish.fused_with_up->norm() > 0)) return report({Fault::usage, "--up needs a direction, as 0,0,1"});
  }
  for (const std::string& name : options.named) {
    auto device = named_device(name);
    if (!device) return report(device.error());
    wish.named.push_back(std::move(*device));
  }
  const auto relay = PoseRelay::open(std::move(wish), [](const std::string& warning) {
    std::fprintf(stderr, "fude: %s\n", warning.c_str());
  });
  if (!relay) return report(relay.error());
  const char* address = options.doors.address.c_str();
  if (const TcpServer* server = (*relay)->servers().openigtlink())
    std::printf("OpenIGTLink %s:%u\n", address, unsigned{server->port()});
  if (const TcpServer* server = (*relay)->servers().vrpn())
    std::printf("VRPN %s:%u\n", address, unsigned{server->port()});
  std::fflush(stdout);
  const Timestamp start = monotonic_now();
  bool interrupted = false;
  std::size_t told = 0;
  while (!interrupted && (options.seconds <= 0 || seconds(monotonic_now() - start) < options.seconds)) {
    interrupted = interrupt.wait(attendance);
    (*relay)->attend();
    const auto relayed = (*relay)->relayed();
    for (; told < relayed.size(); ++told) std::fprintf(stderr, "serving %s\n", relayed[told].name.c_str());
  }
  for (const PoseRelay::Relayed& tool : (*relay)->relayed())
    std::printf("%s: %llu given\n", tool.name.c_str(), static_cast<unsigned long long>(tool.given));
  return interrupted ? 130 : 0;
}

}  // namespace

void add_serve(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("serve", "gives what the trackers see to other programs (OpenIGTLink, VRPN)");
  command->add_option("--add", options->named,
                      "a tracker that is not found by itself: fastrak:/dev/ttyS0@115200, "
                      "openigtlink:HOST:PORT, vrpn:HOST …; may be given again");
  command->add_flag("--fuse", options->fuse,
                    "the first tool together with the first inertial unit, as one more tool: fused");
  add_numbers_option(*command, "--up", "x,y,z of up in the tracker's frame, for --fuse; 0,0,1 without",
                     [options = options.get()](const Eigen::Vector3d& up) { options->up = up; });
  command
      ->add_option("--predict-ms", options->predict_ms,
                   "the fused tool so much ahead of its time, as it moves now: for a display, not to be kept")
      ->check(CLI::Range(0.0, 1e3 * seconds(Fusion::longest_prediction)));
  command->add_option("--listen", options->doors.address,
                      "the address that others reach: 0.0.0.0 for every network of this machine");
  command->add_option("--openigtlink-port", options->doors.openigtlink, "0: a free one");
  command->add_option("--vrpn-port", options->doors.vrpn, "0: a free one");
  command->add_option("--seconds", options->seconds, "how long; without it until Ctrl-C")
      ->check(CLI::Range(0.001, 1e6));
  command->callback([options, &status] { status = serve(*options); });
}

}  // namespace fude
