#include "sim/brush/footprint.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fude {
namespace {

using Eigen::Vector2d;
constexpr double sweep_step_mm = 0.4;
constexpr int most_steps = 24;

BrushSurface between(const BrushSurface& a, const BrushSurface& b, double t) {
  BrushSurface mixed;
  mixed.reserve(b.size());
  for (std::size_t tuft = 0; tuft < b.size(); ++tuft) mixed.push_back(between(a[tuft], b[tuft], t));
  return mixed;
}

double largest_motion_mm(const BrushSurface& a, const BrushSurface& b) {
  double largest = 0;
  for (std::size_t tuft = 0; tuft < b.size(); ++tuft)
    largest = std::max(largest, largest_motion_mm(a[tuft], b[tuft]));
  return largest;
}

}  // namespace

void FootprintSweep::Instant::take(const BrushSurface& surface) {
  contacts.resize(surface.size());
  for (std::size_t tuft = 0; tuft < surface.size(); ++tuft) contacts[tuft].take(surface[tuft]);
}

void FootprintSweep::Instant::add_to(WindingFill& filling) const {
  for (const ContactMesh& contact : contacts) contact.add_to(filling);
}

void FootprintSweep::come_from_nowhere() {
  last_.clear();
  count_ = 0;
  settled_.reset({});
}

void FootprintSweep::come_from(const BrushSurface& surface) {
  last_ = surface;
  count_ = 0;
  append_instant().take(surface);
  settled_known_ = false;
}

FootprintSweep::Instant& FootprintSweep::append_instant() {
  if (count_ == instants_.size()) instants_.emplace_back();
  Instant& instant = instants_[count_++];
  instant.duration_s = 0;
  instant.ends_step = true;
  return instant;
}

void FootprintSweep::find_instants(std::span<const TimedSurface> after) {
  const BrushSurface* last = last_.empty() ? nullptr : &last_;
  for (const TimedSurface& timed : after) {
    if (!last) {
      append_instant().take(timed.surface);
      last = &timed.surface;
      continue;
    }
    const double motion = largest_motion_mm(*last, timed.surface);
    const int steps = std::clamp(static_cast<int>(std::ceil(motion / sweep_step_mm)), 1, most_steps);
    const double dt = timed.since_last_s / steps;
    for (int k = 1; k <= steps; ++k) {
      // Trapezoidal rule: an instant stands for half the time on either side.
      instants_[count_ - 1].duration_s += 0.5 * dt;
      Instant& instant = append_instant();
      instant.duration_s = 0.5 * dt;
      instant.ends_step = k == steps;
      instant.take(instant.ends_step ? timed.surface
                                             : between(*last, timed.surface, static_cast<double>(k) / steps));
    }
    last = &timed.surface;
  }
}

std::optional<CoverageFrame> FootprintSweep::frame_of_instants(double cell_mm) const {
  Vector2d low = Vector2d::Constant(1e300);
  Vector2d high = -low;
  for (std::size_t i = 0; i < count_; ++i)
    for (const ContactMesh& mesh : instants_[i].contacts)
      for (const ContactRing& ring : mesh.contact().rings)
        for (const Vector2d& p : ring.point) {
          low = low.cwiseMin(p);
          high = high.cwiseMax(p);
        }
  if (low.x() > high.x()) return std::nullopt;
  return frame_around(low, high, cell_mm);
}

// Fills in the map what is fresh and for how long it was touched.
void FootprintSweep::find_coverage(const CoverageFrame& frame, FootprintMap& map) {
  filling_.start(frame);
  const bool from_nowhere = last_.empty();
  if (from_nowhere || settled_known_) {
    settled_.move_to(frame);
  } else {
    settled_.reset(frame);
    instants_[0].add_to(filling_);
    filling_.fill(settled_);
  }
  if (!from_nowhere) settled_.add_shares(static_cast<float>(instants_[0].duration_s), map.contact_s);
  touched_.reset(frame);
  fresh_.reset(frame);
  passed_.reset(frame);
  for (std::size_t i = from_nowhere ? 0 : 1; i < count_; ++i) {
    const Instant& instant = instants_[i];
    now_.reset(frame);
    instant.add_to(filling_);
    filling_.fill(now_);
    now_.add_shares(static_cast<float>(instant.duration_s), map.contact_s);
    if (i > 0) {
      for (std::size_t tuft = 0; tuft < instant.contacts.size(); ++tuft)
        for_each_passage(
            instants_[i - 1].contacts[tuft], instant.contacts[tuft],
            [&](const MeshPoint& a, const MeshPoint& b, const MeshPoint& c, const MeshPoint& d) {
              filling_.add_quad(a.at, b.at, c.at, d.at);
            });
      filling_.fill(passed_);
    }
    if (!instant.ends_step) {
      passed_.add(now_);
      continue;
    }
    add_step({settled_, now_}, passed_, fresh_, touched_);
    std::swap(settled_, now_);
  }
  fresh_.add_shares(1, map.fresh);
}

// Newly covered paper takes after the hair that came over it first; where streaks are open, after that on the
// very rim, so that they run on from one frame to the next. What is covered on and on takes after the hair
// that touches it last.
void FootprintSweep::stamp(FootprintMap& map, const HairLook& look) const {
  double widest = 0;
  for (std::size_t i = 0; i < count_; ++i)
    for (const ContactMesh& mesh : instants_[i].contacts)
      for (const ContactRing& ring : mesh.contact().rings) widest = std::max(widest, ring.hair.spread);
  Stamp stamp(touched_.frame(), look, widest, map);
  const auto add = [&](std::size_t i) {
    for (std::size_t tuft = 0; tuft < look.tufts.size(); ++tuft)
      stamp.add(tuft, instants_[i].contacts[tuft].contact());
  };
  if (count_ > 2) stamp.wait_for(fresh_);
  for (std::size_t i = 1; i < count_ && stamp.waits(); ++i) add(i);
  stamp.wait_for(touched_);
  for (std::size_t i = count_; i-- > 0 && stamp.waits();) add(i);
  stamp.name_rest(instants_[count_ - 1].contacts);
  if (!stamp.streaky()) return;
  stamp.wait_for_rim(fresh_);
  for (std::size_t i = 1; i < count_ && stamp.rim_waits(); ++i)
    for (std::size_t tuft = 0; tuft < look.tufts.size(); ++tuft)
      stamp.add_passage(tuft, instants_[i - 1].contacts[tuft], instants_[i].contacts[tuft]);
  stamp.finish();
}

std::optional<FootprintMap> FootprintSweep::sweep(std::span<const TimedSurface> after, double cell_mm,
                                                  const HairLook& look) {
  if (after.empty()) return std::nullopt;
  find_instants(after);
  std::optional<FootprintMap> map;
  if (const auto frame = frame_of_instants(cell_mm)) {
    map.emplace();
    map->left_mm = frame->left_mm();
    map->bottom_mm = frame->bottom_mm();
    map->cell_mm = cell_mm;
    map->columns = frame->columns();
    map->rows = frame->rows;
    const auto cells = static_cast<std::size_t>(map->columns) * static_cast<std::size_t>(map->rows);
    map->fresh.assign(cells, 0);
    map->contact_s.assign(cells, 0);
    find_coverage(*frame, *map);
    stamp(*map, look);
  } else {
    settled_.reset({});
  }
  settled_known_ = true;
  last_ = after.back().surface;
  std::swap(instants_[0], instants_[count_ - 1]);
  instants_[0].duration_s = 0;
  count_ = 1;
  return map;
}

}  // namespace fude
