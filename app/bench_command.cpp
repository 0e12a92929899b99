#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "app/commands.h"
#include "app/painting_options.h"
#include "calibration/fusion/bench_fusion.h"
#include "rig/bench_haptic.h"
#include "rig/bench_pipeline.h"
#include "rig/bench_record.h"
#include "sim/brush/bench_brush.h"
#include "sim/brush/bench_gesture.h"
#include "sim/ink/bench_ink.h"

#ifdef FUDE_PEERS
#include "sim/brush/bench_peers.h"
#endif

namespace fude {
namespace {

using Json = nlohmann::ordered_json;

void print(const Json& figures, bool json) {
  if (json) {
    std::printf("%s\n", figures.dump(2).c_str());
    return;
  }
  for (const auto& [name, value] : figures.items())
    std::printf("%-20s %s\n", name.c_str(), value.dump().c_str());
}

void add_ink(CLI::App& bench, int& status) {
  struct Options {
    InkBenchSetup setup;
    std::string stage = "full", backend = "cpu", isa = "auto";
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  options->setup.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  CLI::App* command = bench.add_subcommand("ink", "steps of the ink, against copying memory");
  InkBenchSetup& setup = options->setup;
  command->add_option("--size", setup.side_cells, "cells a side");
  command->add_option("--wet", setup.wet, "share of the sheet that is wet");
  command->add_option("--steps", setup.steps, "how many");
  command->add_option("--stage", options->stage, "lattice: water alone")
      ->check(CLI::IsMember({"lattice", "full"}));
  command->add_option("--threads", setup.threads, "of the CPU back-end");
  command->add_option("--backend", options->backend, "what runs the ink")
      ->check(CLI::IsMember({"cpu", "gl", "auto"}));
  command->add_option("--isa", options->isa, "instructions of the CPU back-end")
      ->check(CLI::IsMember({"sse2", "avx2", "avx512", "auto"}));
  command->add_flag("--dense", setup.dense, "every cell is stepped, wet or not");
  command->add_flag("--json", options->json, "as JSON");
  command->callback([options, &status] {
    InkBenchSetup& s = options->setup;
    s.stage = options->stage == "lattice" ? Stage::water : Stage::full;
    s.instruction_set = instruction_set_named(options->isa);
    s.backend = options->backend == "auto" ? best_ink_backend()
                : options->backend == "gl" ? InkBackend::gl
                                           : InkBackend::cpu;
    const bool on_card = s.backend == InkBackend::gl;
    const auto b = bench_ink(s);
    if (!b) {
      status = report(b.error());
      return;
    }
    print(Json{{"backend", on_card ? "gl" : "cpu"},
               {"isa", on_card ? "" : name_of(b->instruction_set)},
               {"threads", b->threads},
               {"cells", b->cells},
               {"wet_cells", b->wet_cells},
               {"active_cells", b->active_cells},
               {"stage", options->stage},
               {"ms_per_step", {{"median", b->median_ms}, {"p99", b->p99_ms}}},
               {"mlups", b->mlups},
               {"copy_gb_s", b->copy_gb_s},
               {"bandwidth_fraction", b->bandwidth_fraction}},
          options->json);
  });
}

Json times(const BrushBench::Times& t) { return {{"median", t.median}, {"p99", t.p99}, {"max", t.max}}; }

Json brush_figures(const BrushSpec& spec, const BenchGesture& gesture, int tufts, bool footprint) {
  const BrushBench b = bench_brush(spec, gesture, tufts);
  Json figures{{"gesture", gesture.name},
               {"tufts", tufts},
               {"frames", b.frames},
               {"us_per_frame", times(b.us_per_frame)},
               {"iterations", {{"median", b.iterations_median}, {"max", b.iterations_max}}},
               {"unconverged", b.unconverged},
               {"max_violation", b.max_violation}};
  if (footprint) {
    const MoveBench m = bench_move(spec, gesture);
    figures["at_1_khz"] = {{"frames", m.frames},
                           {"marks", m.marks},
                           {"us_per_frame", times(m.us_per_frame)},
                           {"unconverged", m.unconverged}};
  }
#ifdef FUDE_PEERS
  const PeerBench p = bench_peers(spec, gesture);
  const auto one = [](const PeerFigures& f) {
    return Json{{"frames", f.frames},
                {"us_per_frame", times(f.us_per_frame)},
                {"energy", f.energy},
                {"max_violation", f.max_violation},
                {"failures", f.failures}};
  };
  figures["peer"] = {{p.own.name, one(p.own)}};
  for (const PeerFigures& peer : p.peers) figures["peer"][peer.name] = one(peer);
  figures["energy_above_best_peer"] = {{"worst", p.worst_gap}, {"frame", p.worst_frame}};
#endif
  return figures;
}

void add_brush(CLI::App& bench, int& status) {
  struct Options {
    std::string brush = "round-goat", gesture = std::string(bench_gestures()[0].name);
    int tufts = 1;
    bool footprint = false, json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = bench.add_subcommand("brush", "solves of a tuft along a gesture of eight seconds");
  command->add_option("--brush", options->brush, "a brush of share/brushes, or a TOML file");
  std::vector<std::string> names = {"all"};
  for (const BenchGesture& gesture : bench_gestures()) names.emplace_back(gesture.name);
  command->add_option("--gesture", options->gesture, "what the hand does")
      ->check(CLI::IsMember(names))
      ->capture_default_str();
  command->add_option("--tufts", options->tufts, "side by side, solved one after the other")
      ->check(CLI::Range(1, 64));
  command->add_flag("--footprint", options->footprint,
                    "also whole frames at 1 kHz, footprint and ink with them");
  command->add_flag("--json", options->json, "as JSON");
  command->callback([options, &status] {
    PaintingOptions painting;
    painting.brush = options->brush;
    const auto settings = painting.settings();
    if (!settings) {
      status = report(settings.error());
      return;
    }
    for (const BenchGesture& gesture : bench_gestures())
      if (options->gesture == "all" || options->gesture == gesture.name)
        print(brush_figures(settings->painting.brush, gesture, options->tufts, options->footprint),
              options->json);
  });
}

void add_pipeline(CLI::App& bench, int& status) {
  struct Options {
    PaintingOptions painting;
    double seconds = 5;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      bench.add_subcommand("pipeline", "pen event to ink, while 512 x 512 wet cells are stepped");
  options->painting.add_to(*command);
  command->add_option("--seconds", options->seconds, "how long")->check(CLI::Range(0.1, 600.0));
  command->add_flag("--json", options->json, "as JSON");
  command->callback([options, &status] {
    const auto settings = options->painting.settings();
    const auto b = settings ? bench_pipeline(settings->painting, options->seconds)
                            : Result<PipelineBench>(tl::unexpected(settings.error()));
    if (!b) {
      status = report(b.error());
      return;
    }
    print(Json{{"latency_us", {{"median", b->latency_us.median}, {"p99", b->latency_us.p99}}},
               {"events", b->events},
               {"steps", b->steps},
               {"wet_cells", b->wet_cells}},
          options->json);
  });
}

void add_haptic(CLI::App& bench, int& status) {
  struct Options {
    PaintingOptions painting;
    double seconds = 10;
    bool in_turn = false, json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = bench.add_subcommand(
      "haptic", "an arm's loop of 1 kHz against a bare timer, while 512 x 512 wet cells are stepped");
  options->painting.add_to(*command);
  command->add_option("--seconds", options->seconds, "how long each")->check(CLI::Range(0.5, 600.0));
  command->add_flag("--in-turn", options->in_turn, "loop and timer by half seconds, not both at once");
  command->add_flag("--json", options->json, "as JSON");
  command->callback([options, &status] {
    const auto settings = options->painting.settings();
    const auto b = settings ? bench_haptic(settings->painting, options->seconds,
                                           options->in_turn ? HapticTurns::in_turn : HapticTurns::together)
                            : Result<HapticBench>(tl::unexpected(settings.error()));
    if (!b) {
      status = report(b.error());
      return;
    }
    const auto pace = [](const falcon::Pace::Counts& counts) {
      return Json{{"periods", counts.periods}, {"late", counts.late}};
    };
    print(Json{{"precedence", b->precedence},
               {"timer", pace(b->timer)},
               {"loop", pace(b->loop)},
               {"late_excess", late_excess(*b)},
               {"samples", b->samples},
               {"felt", b->felt},
               {"steps", b->steps}},
          options->json);
  });
}

void add_record_bench(CLI::App& bench, int& status) {
  struct Options {
    std::string out = "bench-record.fude";
    double seconds = 10;
    std::size_t picture_bytes = 150000;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      bench.add_subcommand("record", "a whole rig at once: 4 tablets, 4 handles, 2 trackers, a camera");
  command->add_option("--out", options->out, "the session, replaced and removed again")
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "how long")->check(CLI::Range(0.1, 3600.0));
  command->add_option("--picture-bytes", options->picture_bytes, "of a camera's picture")
      ->check(CLI::Range(1, 10000000))
      ->capture_default_str();
  command->add_flag("--json", options->json, "as JSON");
  command->callback([options, &status] {
    const auto b = bench_record(options->out, options->seconds, options->picture_bytes);
    if (!b) {
      status = report(b.error());
      return;
    }
    print(Json{{"offered", b->offered},
               {"kept", b->kept},
               {"cores", b->cores},
               {"peak_mb", b->peak_mb},
               {"session_mb", b->session_mb},
               {"byte_to_sample_us", {{"p50", b->delay_us_p50}, {"p99", b->delay_us_p99}}}},
          options->json);
  });
}

void add_fusion(CLI::App& bench, int& status) {
  auto json = std::make_shared<bool>(false);
  CLI::App* command = bench.add_subcommand("fusion", "inertial samples, positions, late ones");
  command->add_flag("--json", *json, "as JSON");
  command->callback([json, &status] {
    status = 0;
    const FusionBench b = bench_fusion();
    print(Json{{"ns_per_orientation", b.ns_per_orientation},
               {"ns_per_inertial", b.ns_per_inertial},
               {"ns_per_position", b.ns_per_position},
               {"us_per_late", b.us_per_late},
               {"core_share", b.core_share}},
          *json);
  });
}

}  // namespace

void add_bench(CLI::App& app, int& status) {
  CLI::App* bench = app.add_subcommand("bench", "measures this machine");
  bench->require_subcommand(1);
  add_ink(*bench, status);
  add_brush(*bench, status);
  add_fusion(*bench, status);
  add_pipeline(*bench, status);
  add_haptic(*bench, status);
  add_record_bench(*bench, status);
}

}  // namespace fude
