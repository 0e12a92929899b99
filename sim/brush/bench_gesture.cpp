#include "sim/brush/bench_gesture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "signal/elementary.h"

namespace fude {
namespace {

using elementary::cosine;
using elementary::sine;
constexpr double pi = std::numbers::pi;

// From 0 to 1, at rest at both ends, and its second derivative with it.
double ease(double t) {
  const double u = std::clamp(t, 0.0, 1.0);
  return u * u * u * (10 - u * (15 - 6 * u));
}

Eigen::Quaterniond about(const Eigen::Vector3d& axis, double angle) {
  const auto [s, c] = elementary::sine_cosine(0.5 * angle);
  Eigen::Quaterniond q;
  q.w() = c;
  q.vec() = s * axis;
  return q;
}
Eigen::Quaterniond about_x(double angle) { return about(Eigen::Vector3d::UnitX(), angle); }
Eigen::Quaterniond about_y(double angle) { return about(Eigen::Vector3d::UnitY(), angle); }
Eigen::Quaterniond about_z(double angle) { return about(Eigen::Vector3d::UnitZ(), angle); }

// Of a tuft of 32 mm.
Pose<Paper, Handle> at(const BrushSpec& spec, const Eigen::Vector3d& mm, const Eigen::Quaterniond& turn) {
  return {turn, mm * (spec.tuft_length_mm / 32)};
}

// Down at the beginning and up at the end.
double set_down_and_lifted(double t, double up, double down) {
  return up - (up - down) * ease(t / 1.2) + (up - down + 2) * ease((t - 6.5) / 1.2);
}

// In from the air, pressed, drawn along with changing pressure, turned, lifted off and away.
Pose<Paper, Handle> stroke(const BrushSpec& spec, double t) {
  const double wave = sine(3 * t) * ease(t - 1) * (1 - ease(2 * t - 10));
  const double drag = ease((t - 1) / 2.5);
  const double turn = ease((t - 3.5) / 2.5);
  return at(spec,
            {60 * drag + 20 * sine(3 * turn), -40 * turn,
             36 - 18 * ease(t / 1.2) + 4 * wave + 20 * ease((t - 6) / 1.2)},
            about_y(0.15 * cosine(t)) * about_x(0.25) * about_z(turn));
}

// The tip points ahead and the hand pushes it on against the paper.
Pose<Paper, Handle> pushed(const BrushSpec& spec, double t) {
  return at(spec, {70 * ease((t - 1.5) / 5), 3 * sine(1.5 * t), set_down_and_lifted(t, 34, 22)},
            about_y(-0.5) * about_x(0.1 * sine(t)));
}

// Four dots, each pressed and lifted in place.
Pose<Paper, Handle> dab(const BrushSpec& spec, double t) {
  const double down = sine(0.5 * pi * t);
  const double square = down * down;
  const double moves = 15 * (ease(t - 1.5) + ease(t - 3.5) + ease(t - 5.5));
  return at(spec, {moves, 0.3 * moves, 38 - 20 * square * square}, about_y(0.25) * about_x(0.2));
}

// Pressed hard and rubbed to and fro.
Pose<Paper, Handle> rub(const BrushSpec& spec, double t) {
  const double rubbing = ease(t - 1.2) * (1 - ease(t - 6));
  return at(spec, {8 * rubbing * sine(2 * pi * 1.5 * t), 3 * t, set_down_and_lifted(t, 36, 17)},
            about_x(0.3) * about_y(0.1 * sine(2 * pi * 1.5 * t)));
}

// Eight fast lines of 50 mm in a fifth of a second each.
Pose<Paper, Handle> flick(const BrushSpec& spec, double t) {
  const double line = std::floor(t);
  const double u = t - line;
  const double down = ease((u - 0.2) / 0.2) * (1 - ease((u - 0.5) / 0.2));
  return at(spec, {50 * ease((u - 0.4) / 0.2) * (1 - ease((u - 0.75) / 0.25)), 5 * t, 36 - 14 * down},
            about_y(0.3) * about_x(0.1));
}

// Pressed and turned about its own axis and about the upright, two and a half times.
Pose<Paper, Handle> twirl(const BrushSpec& spec, double t) {
  const double turn = 5 * pi * ease((t - 1.2) / 5);
  return at(spec, {6 * sine(turn), 6 - 6 * cosine(turn), set_down_and_lifted(t, 36, 20)},
            about_z(turn) * about_x(0.3) * about_z(0.5 * turn));
}

constexpr std::array<BenchGesture, 6> gestures = {{
    {"stroke", "pressed, drawn, turned and lifted", stroke},
    {"pushed", "the tip ahead, pushed on", pushed},
    {"dab", "four dots in place", dab},
    {"rub", "to and fro under pressure", rub},
    {"flick", "eight lines of 50 mm in 0.2 s each", flick},
    {"twirl", "turned about its own axis and about the upright", twirl},
}};

}  // namespace

std::span<const BenchGesture> bench_gestures() { return gestures; }

}  // namespace fude
