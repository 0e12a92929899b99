#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>

#include "app/commands.h"
#include "app/interrupt.h"
#include "rig/session_player.h"

namespace fude {
namespace {

struct Options {
  std::string session, stream;
  double speed = 1;
  double from_s = 0;
  double delay_s = 1;
  std::size_t clients = 0;
  bool as_devices = false;
  PoseServers::Doors doors;
};

// The kernel forgets what a reader has not fetched when the device goes.
constexpr Duration fetching = std::chrono::milliseconds(200);
constexpr Duration a_day = std::chrono::hours(24);

Duration duration_of(double seconds) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(seconds));
}

std::size_t clients_of(const SessionPlayer& player) {
  std::size_t clients = 0;
  if (const PoseServers* servers = player.servers())
    for (const TcpServer* server : {servers->openigtlink(), servers->vrpn()})
      if (server) clients += server->clients();
  return clients;
}

// On a thread of its own. True when it came to the end.
bool perform(SessionPlayer& player, const Options& options) {
  const auto enough = [&] { return clients_of(player) >= options.clients; };
  if (options.clients > 0 && player.servers() && !player.stand(a_day, enough)) return false;
  if (!player.stand(duration_of(options.delay_s)) || !player.play({})) return false;
  for (const PlayedStream& stream : player.streams())
    if (!stream.outlet.empty()) return player.stand(fetching);
  return true;
}

int play(const Options& options) {
  InterruptWatch interrupt;  // before any thread starts
  auto session = read_session(options.session);
  if (!session) return report(session.error());
  PlayWish wish;
  wish.speed = options.speed;
  wish.from = duration_of(options.from_s);
  wish.stream = options.stream;
  wish.doors = options.doors;
  auto opened = SessionPlayer::open(std::move(*session), wish, std::make_shared<SystemClock>(), make_uinput);
  if (!opened) return report({opened.error().fault, options.session + ": " + opened.error().message});
  SessionPlayer& player = **opened;
  std::size_t told = 0;
  const auto tell_notes = [&] {
    for (; told < player.notes().size(); ++told)
      std::fprintf(stderr, "fude: %s\n", player.notes()[told].c_str());
  };
  tell_notes();
  for (const PlayedStream& stream : player.streams())
    std::printf("%s: %s\n", stream.name.c_str(),
                stream.outlet.empty() ? "in this process alone" : stream.outlet.c_str());
  std::fflush(stdout);

  std::atomic<bool> over{false};
  bool whole = false;
  std::thread playing([&] {
    whole = perform(player, options);
    over = true;
  });
  constexpr Duration glance = std::chrono::milliseconds(20);
  bool interrupted = false;
  while (!over && !interrupted) interrupted = interrupt.wait(glance);
  if (interrupted) player.stop();
  playing.join();
  tell_notes();
  for (const PlayedStream& stream : player.streams()) {
    std::printf("%s: %llu given", stream.name.c_str(), static_cast<unsigned long long>(stream.given));
    if (stream.samples > 0) std::printf(", %llu samples", static_cast<unsigned long long>(stream.samples));
    std::printf("\n");
  }
  return whole ? 0 : 130;
}

}  // namespace

void add_play(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("play", "gives a session back as live devices");
  command->add_option("SESSION", options->session, "a .fude session")->required();
  command
      ->add_flag("--as-devices", options->as_devices,
                 "input devices of the kernel (uinput); poses over OpenIGTLink and VRPN on this machine")
      ->required();
  command->add_option("--speed", options->speed, "times the recorded pace; 0: as fast as it is taken")
      ->check(CLI::Range(0.0, 1e6));
  command->add_option("--from", options->from_s, "seconds after the session's beginning")
      ->check(CLI::Range(0.0, 1e9));
  command->add_option("--stream", options->stream, "this device or stream alone, named as in fude info");
  command->add_option("--openigtlink-port", options->doors.openigtlink, "0: a free one");
  command->add_option("--vrpn-port", options->doors.vrpn, "0: a free one");
  command->add_option("--delay", options->delay_s, "seconds that the devices stand before they move")
      ->check(CLI::Range(0.0, 3600.0));
  command->add_option("--await-clients", options->clients, "begin when so many have connected");
  command->callback([options, &status] { status = play(*options); });
}

}  // namespace fude
