#include "sim/brush/brush.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace fude {
namespace {

constexpr double out_of_reach_mm = 1e4;  // height at which nothing touches
constexpr double gap_s = 0.25;           // a longer silence is a new stroke
constexpr double jump_mm = 60;           // in one frame: no hand moves like that
constexpr int most_steps = 16;
constexpr double longest_flow_s = 10;  // after it a tuft is as even as it gets

bool finite(const Pose<Paper, Handle>& pose) {
  return pose.rotation.coeffs().allFinite() && pose.translation.allFinite() &&
         pose.translation.cwiseAbs().maxCoeff() < 1e5 && std::abs(pose.rotation.squaredNorm() - 1) < 1e-3;
}

// Straight line, and the short way round (normalised linear interpolation: no angle is needed, and
// between two frames it cannot be told from an even turn).
Pose<Paper, Handle> between(const Pose<Paper, Handle>& a, const Pose<Paper, Handle>& b, double t) {
  if (t == 1) return b;
  Pose<Paper, Handle> pose;
  const double sign = a.rotation.dot(b.rotation) < 0 ? -1 : 1;
  pose.rotation.coeffs() = (1 - t) * a.rotation.coeffs() + sign * t * b.rotation.coeffs();
  pose.rotation.normalize();
  pose.translation = (1 - t) * a.translation + t * b.translation;
  return pose;
}

// 0 where time stands still or runs backwards; any two stamps have a difference.
double seconds_since(Timestamp last, Timestamp now) {
  if (now <= last) return 0;
  const auto ticks = [](Timestamp t) { return static_cast<std::uint64_t>(t.time_since_epoch().count()); };
  return static_cast<double>(ticks(now) - ticks(last)) * 1e-9;
}

void take_worse(SolveReport& sum, const SolveReport& step) {
  sum.iterations = std::max(sum.iterations, step.iterations);
  sum.converged = sum.converged && step.converged;
  sum.kkt_residual = std::max(sum.kkt_residual, step.kkt_residual);
  sum.violation_mm = std::max(sum.violation_mm, step.violation_mm);
  sum.energy_mn_mm = step.energy_mn_mm;
  sum.on_hand = step.on_hand;
}

}  // namespace

Brush::Brush(const BrushSpec& spec, std::uint64_t seed)
    : tuft_(make_tuft(spec)), flow_(flow_in(tuft_)), texture_(spec, seed) {
  state_.tuft = rest_state(tuft_);
  state_.loading = dry_loading(tuft_);
}

// Springs back in free air, in one step however long it was away.
void Brush::away(double elapsed_s) {
  Pose<Paper, Handle> pose = state_.tuft.paper_from_handle;
  pose.translation.z() = out_of_reach_mm;
  advance(tuft_, state_.tuft, pose, elapsed_s, true);
  state_.footprint = {};
  even_out(state_.loading, flow_, std::min(elapsed_s, longest_flow_s));
}

// The tuft with the ink that clings to it, as its last footprint shows it.
TuftSurface Brush::marked_surface() const {
  TuftSurface surface = surface_of(tuft_, state_.tuft.x, state_.tuft.paper_from_handle);
  press(tuft_, state_.tuft.reactions, surface);
  return swollen(std::move(surface), state_.footprint.soak_mm);
}

void Brush::take_footprint() { state_.footprint = {true, tuft_.spec.soak_mm * wetness(state_.loading)}; }

// The seconds since the last input.
double Brush::pass_time(const BrushInput& input) {
  const bool first = !state_.timed;
  const double elapsed_s = first ? 0 : seconds_since(state_.last, input.time.host);
  state_.last = first ? input.time.host : std::max(state_.last, input.time.host);
  state_.timed = true;
  return elapsed_s;
}

void Brush::visit(const BrushInput& input, const PaletteSpot& spot) {
  const double elapsed_s = pass_time(input);
  if (input.origin == PoseOrigin::none || !finite(input.paper_from_handle)) return away(elapsed_s);
  // It hangs free: as in the air, turned as the hand turns it.
  Pose<Paper, Handle> raised = input.paper_from_handle;
  raised.rotation.normalize();
  raised.translation.z() = out_of_reach_mm;
  advance(tuft_, state_.tuft, raised, elapsed_s, true);
  state_.footprint = {};
  sweep_.come_from_nowhere();
  const TuftSurface hair = surface_of(tuft_, state_.tuft.x, raised);
  const double lowest = std::ranges::min(hair, {}, [](const Station& s) { return s.centre.z(); }).centre.z();
  double level = out_of_reach_mm - input.paper_from_handle.translation.z();
  if (const auto* bath = std::get_if<Bath>(&spot)) level = std::min(level, lowest + bath->depth_mm);
  const bool stays = !input.after_gap && elapsed_s <= gap_s;
  stay_at(state_.loading, tuft_, flow_, spot, immersed_below(hair, level), stays ? elapsed_s : 0);
  if (std::holds_alternative<Rim>(spot) && level > lowest) reshape();
}

BrushFrame Brush::move(const BrushInput& input) {
  BrushFrame frame;
  const double elapsed_s = pass_time(input);
  if (input.origin == PoseOrigin::none || !finite(input.paper_from_handle)) {
    away(elapsed_s);
    return frame;
  }

  Pose<Paper, Handle> target = input.paper_from_handle;
  target.rotation.normalize();
  target = reachable_pose(tuft_, target);
  const Pose<Paper, Handle> start = state_.tuft.paper_from_handle;
  const bool jumped = input.after_gap || elapsed_s > gap_s || !state_.footprint.taken ||
                      (target.translation - start.translation).norm() > jump_mm;
  if (jumped) sweep_.come_from_nowhere();
  frame.steps = jumped ? 1
                       : std::clamp(static_cast<int>(std::ceil(elapsed_s / tuft_.spec.longest_step_s - 1e-6)),
                                    1, most_steps);
  const double step_s = elapsed_s / frame.steps;
  std::vector<TimedSurface> after;
  for (int k = 1; k <= frame.steps; ++k) {
    const Pose<Paper, Handle> pose =
        jumped ? target : between(start, target, static_cast<double>(k) / frame.steps);
    take_worse(frame.solve, advance(tuft_, state_.tuft, pose, step_s, jumped));
    take_footprint();
    after.push_back({marked_surface(), step_s});
  }

  const std::vector<InkLoad> looks = offered(state_.loading);
  std::optional<FootprintMap> map = sweep_.sweep(after, tuft_.spec.cell_mm, {texture_, looks, grain_.get()});
  if (!map) {
    even_out(state_.loading, flow_, std::min(elapsed_s, longest_flow_s));
    return frame;
  }
  std::vector<InkLoad> loads = draw_for(*map, elapsed_s);
  frame.deposit = Deposit{std::move(*map), std::move(loads)};
  return frame;
}

std::vector<InkLoad> Brush::draw_for(const FootprintMap& map, double elapsed_s) {
  const double step_s = std::min(elapsed_s, longest_flow_s);
  if (film_ul_mm2_ == 0) {
    even_out(state_.loading, flow_, step_s);
    return offered(state_.loading);
  }
  PerPatch demand_ul{};
  for (std::size_t i = 0; i < map.fresh.size(); ++i)
    demand_ul[map.patch[i]] += static_cast<double>(map.fresh[i]);
  for (double& demand : demand_ul) demand *= film_ul_mm2_ * map.cell_mm * map.cell_mm;
  return draw(state_.loading, flow_, step_s, demand_ul);
}

void Brush::take(const Exchange& exchange) { book(state_.loading, exchange); }

void Brush::expect_film(double ul_per_mm2) { film_ul_mm2_ = ul_per_mm2; }

void Brush::paint_over(std::shared_ptr<PaperGrain> grain) { grain_ = std::move(grain); }

void Brush::tend(const BrushCare& care) {
  fude::tend(state_.loading, tuft_, flow_, care, AcrossBrush{});
  if (std::holds_alternative<WipeBrush>(care)) reshape();
}

void Brush::set_endless(bool endless) { state_.loading.endless = endless; }

void Brush::reshape() {
  state_.tuft = rest_state(tuft_);
  state_.footprint = {};
}

void Brush::restore(const BrushState& state) {
  if (state.tuft.x.size() != state_.tuft.x.size()) throw std::invalid_argument("the state of another tuft");
  state_ = state;
  if (state_.footprint.taken)
    sweep_.come_from(marked_surface());
  else
    sweep_.come_from_nowhere();
}

TuftShape Brush::shape() const {
  const Skeleton skeleton = pose_skeleton(tuft_, state_.tuft.x, state_.tuft.paper_from_handle);
  const Layout layout{tuft_.segments};
  TuftShape shape;
  for (int k = 0; k <= tuft_.segments; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const bool stretches = k > 0 && k < tuft_.segments;
    const double rest = (1 - tuft_.spec.lateral_share) * tuft_.radius_mm[i];
    const double a = rest + (stretches ? state_.tuft.x[layout.stretch(k, 0)] : 0);
    const double b = rest + (stretches ? state_.tuft.x[layout.stretch(k, 1)] : 0);
    shape.spine.push_back(skeleton.node[i]);
    shape.lateral_a.push_back(skeleton.node[i] + a * skeleton.lateral[i]);
    shape.lateral_b.push_back(skeleton.node[i] - b * skeleton.lateral[i]);
  }
  shape.sections = surface_of(tuft_, state_.tuft.x, state_.tuft.paper_from_handle);
  return shape;
}

}  // namespace fude
