#include "sim/brush/brush.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sim/brush/row.h"

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

TuftShape shape_of(const Tuft& tuft, const TuftState& state, TuftSurface sections) {
  const Skeleton skeleton = pose_skeleton(tuft, state.x, state.paper_from_handle);
  const Layout layout{tuft.segments};
  TuftShape shape;
  for (int k = 0; k <= tuft.segments; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const bool stretches = k > 0 && k < tuft.segments;
    const double rest = (1 - tuft.spec.lateral_share) * tuft.radius_mm[i];
    const double a = rest + (stretches ? state.x[layout.stretch(k, 0)] : 0);
    const double b = rest + (stretches ? state.x[layout.stretch(k, 1)] : 0);
    shape.spine.push_back(skeleton.node[i]);
    shape.lateral_a.push_back(skeleton.node[i] + a * skeleton.lateral[i]);
    shape.lateral_b.push_back(skeleton.node[i] - b * skeleton.lateral[i]);
  }
  shape.sections = std::move(sections);
  return shape;
}

}  // namespace

Brush::Brush(const BrushSpec& spec, std::uint64_t seed)
    : tuft_(make_tuft(spec)), flow_(flow_in(tuft_)), seed_(seed) {
  grow(arrangement(spec, seed));
  state_.loading = dry_loading(tuft_);
}

void Brush::grow(const std::vector<TuftRoot>& roots) {
  state_.tufts.clear();
  for (const TuftRoot& root : roots) state_.tufts.push_back({root, {}});
  make_tufts();
  for (std::size_t i = 0; i < made_.size(); ++i) state_.tufts[i].state = rest_state(made_[i].tuft);
}

void Brush::make_tufts() {
  made_.clear();
  for (const BrushTuft& one : state_.tufts) {
    const BrushSpec& from =
        one.root.parent < 0 ? tuft_.spec : made_[static_cast<std::size_t>(one.root.parent)].tuft.spec;
    const BrushSpec spec = hair_of(from, one.root);
    const std::uint64_t seed = seed_ + made_.size();
    made_.push_back({make_tuft(spec), HairTexture(spec, seed), patches_of(tuft_.spec, one.root)});
  }
}

Pose<Paper, Handle> Brush::root_of(std::size_t tuft) const {
  const TuftRoot& root = state_.tufts[tuft].root;
  if (root.parent < 0) return root_pose(tuft_.spec, root, state_.paper_from_handle);
  const auto parent = static_cast<std::size_t>(root.parent);
  return root_pose(made_[parent].tuft, state_.tufts[parent].state, root);
}

// Of each tuft in a row, how its neighbours bend, on the average.
std::vector<Bends> Brush::neighbours() const {
  if (tuft_.spec.spines == 1) return {};
  std::vector<Bends> bends;
  for (std::size_t i = 0; i < made_.size(); ++i)
    bends.push_back(bends_of(made_[i].tuft, state_.tufts[i].state));
  std::vector<Bends> beside = bends;
  const std::size_t last = bends.size() - 1;
  for (std::size_t i = 0; i <= last; ++i)
    for (std::size_t joint = 0; joint < beside[i].size(); ++joint)
      beside[i][joint] = 0.5 * (bends[i > 0 ? i - 1 : 1][joint] + bends[i < last ? i + 1 : last - 1][joint]);
  return beside;
}

// Each tuft in its turn: a child's root moves with its parent (Chu 2.5.7). All of them pull at one hand.
SolveReport Brush::advance_tufts(double step_s, bool jumped) {
  SolveReport all;
  double energy = 0;
  Wrench on_hand;
  const std::vector<Bends> beside = neighbours();
  for (std::size_t i = 0; i < made_.size(); ++i) {
    const SolveReport one = advance(made_[i].tuft, state_.tufts[i].state, root_of(i), step_s, jumped, nullptr,
                                    beside.empty() ? nullptr : &beside[i]);
    take_worse(all, one);
    energy += one.energy_mn_mm;
    const Eigen::Vector3d lever =
        state_.tufts[i].state.paper_from_handle.translation - state_.paper_from_handle.translation;
    on_hand.force_n += one.on_hand.force_n;
    on_hand.torque_nmm += one.on_hand.torque_nmm + lever.cross(one.on_hand.force_n);
  }
  all.energy_mn_mm = energy;
  all.on_hand = on_hand;
  return all;
}

// Springs back in free air, in one step however long it was away.
void Brush::away(double elapsed_s) {
  state_.paper_from_handle.translation.z() = out_of_reach_mm;
  advance_tufts(elapsed_s, true);
  state_.footprint = {};
  even_out(state_.loading, flow_, std::min(elapsed_s, longest_flow_s));
}

BrushSurface Brush::surface(const std::vector<double>& row_wetness) const {
  BrushSurface surface;
  for (std::size_t i = 0; i < made_.size(); ++i) {
    const TuftState& state = state_.tufts[i].state;
    surface.push_back(surface_of(made_[i].tuft, state.x, state.paper_from_handle));
  }
  if (!row_wetness.empty()) join_row(tuft_.spec, row_wetness, surface);
  return surface;
}

// The tufts with the ink that clings to them, as their last footprint shows them.
BrushSurface Brush::marked_surface() const {
  BrushSurface marked = surface(state_.footprint.wetness);
  for (std::size_t i = 0; i < marked.size(); ++i) {
    press(made_[i].tuft, state_.tufts[i].state.reactions, marked[i]);
    marked[i] = swollen(std::move(marked[i]), state_.footprint.soak_mm);
  }
  return marked;
}

std::vector<TuftHair> Brush::hair() const {
  std::vector<TuftHair> hair;
  for (const Made& made : made_) hair.push_back({&made.texture, made.patches});
  return hair;
}

void Brush::take_footprint() {
  state_.footprint = {true, tuft_.spec.soak_mm * wetness(state_.loading), row_wetness()};
}

std::vector<double> Brush::row_wetness() const {
  if (tuft_.spec.spines == 1) return {};
  const std::vector<InkLoad> loads = offered(state_.loading);
  std::vector<double> row;
  for (const Made& made : made_) {
    double sum = 0;
    for (const std::uint16_t patch : made.patches) sum += static_cast<double>(loads[patch].wetness);
    row.push_back(sum / patch_count);
  }
  return row;
}

// The seconds since the last input.
double Brush::pass_time(const BrushInput& input) {
  const bool first = !state_.timed;
  const double elapsed_s = first ? 0 : seconds_since(state_.last, input.time.host);
  state_.last = first ? input.time.host : std::max(state_.last, input.time.host);
  state_.timed = true;
  return elapsed_s;
}

// What of the brush is below the level: of each patch the share that its tufts tell on the average.
Immersion Brush::immersed(const BrushSurface& hair, double level_mm) const {
  Immersion brush;
  PerPatch tellers{};
  for (std::size_t i = 0; i < made_.size(); ++i) {
    const Immersion tuft = immersed_below(hair[i], level_mm);
    for (std::size_t k = 0; k < patch_count; ++k) {
      brush.patches[made_[i].patches[k]] += tuft.patches[k];
      ++tellers[made_[i].patches[k]];
    }
    for (std::size_t row = 0; row < tuft.inside.size(); ++row)
      brush.inside[row] += tuft.inside[row] / static_cast<double>(made_.size());
  }
  for (std::size_t k = 0; k < patch_count; ++k) brush.patches[k] /= std::max(1.0, tellers[k]);
  return brush;
}

void Brush::visit(const BrushInput& input, const PaletteSpot& spot) {
  const double elapsed_s = pass_time(input);
  if (input.origin == PoseOrigin::none || !finite(input.paper_from_handle)) return away(elapsed_s);
  // It hangs free: as in the air, turned as the hand turns it.
  Pose<Paper, Handle> raised = input.paper_from_handle;
  raised.rotation.normalize();
  raised.translation.z() = out_of_reach_mm;
  state_.paper_from_handle = raised;
  advance_tufts(elapsed_s, true);
  state_.footprint = {};
  sweep_.come_from_nowhere();
  const BrushSurface hair = surface(row_wetness());
  double lowest = out_of_reach_mm;
  for (const TuftSurface& tuft : hair)
    for (const Station& s : tuft) lowest = std::min(lowest, s.centre.z());
  double level = out_of_reach_mm - input.paper_from_handle.translation.z();
  if (const auto* bath = std::get_if<Bath>(&spot)) level = std::min(level, lowest + bath->depth_mm);
  const bool stays = !input.after_gap && elapsed_s <= gap_s;
  stay_at(state_.loading, tuft_, flow_, spot, immersed(hair, level), stays ? elapsed_s : 0);
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
  const Pose<Paper, Handle> start = state_.paper_from_handle;
  const bool jumped = input.after_gap || elapsed_s > gap_s || !state_.footprint.taken ||
                      (target.translation - start.translation).norm() > jump_mm;
  if (jumped) sweep_.come_from_nowhere();
  frame.steps = jumped ? 1
                       : std::clamp(static_cast<int>(std::ceil(elapsed_s / tuft_.spec.longest_step_s - 1e-6)),
                                    1, most_steps);
  const double step_s = elapsed_s / frame.steps;
  std::vector<TimedSurface> after;
  for (int k = 1; k <= frame.steps; ++k) {
    state_.paper_from_handle = jumped ? target : between(start, target, static_cast<double>(k) / frame.steps);
    take_worse(frame.solve, advance_tufts(step_s, jumped));
    take_footprint();
    after.push_back({marked_surface(), step_s});
  }

  const std::vector<InkLoad> looks = offered(state_.loading);
  const std::vector<TuftHair> tufts = hair();
  std::optional<FootprintMap> map = sweep_.sweep(after, tuft_.spec.cell_mm, {tufts, looks, grain_.get()});
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
  grow(arrangement(tuft_.spec, seed_));
  state_.footprint = {};
}

void Brush::restore(const BrushState& state) {
  const BrushState before = std::exchange(state_, state);
  make_tufts();
  for (std::size_t i = 0; i < made_.size(); ++i)
    if (state_.tufts[i].state.x.size() != Layout{made_[i].tuft.segments}.size()) {
      state_ = before;
      make_tufts();
      throw std::invalid_argument("the state of another brush");
    }
  if (state_.footprint.taken)
    sweep_.come_from(marked_surface());
  else
    sweep_.come_from_nowhere();
}

BrushShape Brush::shape() const {
  BrushSurface surfaces = surface(row_wetness());
  BrushShape shape;
  for (std::size_t i = 0; i < made_.size(); ++i) {
    shape.push_back(shape_of(made_[i].tuft, state_.tufts[i].state, std::move(surfaces[i])));
    shape.back().patches = made_[i].patches;
  }
  return shape;
}

}  // namespace fude
