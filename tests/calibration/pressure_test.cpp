#include "calibration/pressure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/fakes/scripted_pen.h"
#include "tests/fakes/scripted_tracker.h"

namespace fude {
namespace {

constexpr double n_per_g = 9.80665e-3;

// A pen as pens are: it feels from 12 g on, gets stiffer, and says 1 from 600 g on.
double felt(double grams) { return std::clamp(std::pow((grams - 12) / 588, 0.6), 0.0, 1.0); }
double truly_n(double pressure) { return n_per_g * (12 + 588 * std::pow(pressure, 1 / 0.6)); }

const std::vector<double> weights{15, 25, 40, 60, 90, 130, 180, 240, 310, 390, 480, 560, 640, 800};

std::vector<PenSample> pressed(const std::vector<double>& grams, double noise_share = 0,
                               std::uint32_t seed = 1) {
  Noise noise(seed);
  std::vector<PenSample> samples;
  for (const double g : grams)
    tap(samples, pen_sample(0, {5000, 5000}, true, felt(g * (1 + noise.normal(noise_share)))));
  return samples;
}

Calibration<PressureCurve> weighed(const std::vector<double>& grams, const std::vector<PenSample>& samples) {
  std::vector<Weighing> weighings;
  for (const double g : grams) weighings.push_back({g, std::nullopt});
  PressureProcedure procedure(weighings);
  for (const PenSample& s : samples) procedure.add(s);
  return procedure.finish();
}

TEST(Pressure, FollowsThePenThatWasWeighed) {
  double rms = 0, worst_threshold = 0;
  constexpr int trials = 20;
  for (std::uint32_t seed = 0; seed < trials; ++seed) {
    const auto found = weighed(weights, pressed(weights, 0.01, seed));
    ASSERT_TRUE(found) << found.error().reason;
    double sum = 0;
    for (int i = 1; i < 100; ++i)
      sum += std::pow(force_n(found->value, Fraction(i / 100.0)) - truly_n(i / 100.0), 2) / 99;
    rms += std::sqrt(sum) / trials;
    worst_threshold = std::max(worst_threshold, std::abs(found->value.force_n.front() - truly_n(0)));
    ASSERT_TRUE(found->value.saturation_n);
    EXPECT_NEAR(*found->value.saturation_n, truly_n(1), 0.4);
  }
  std::printf(
      "figure: pressure, 14 weights read to 1 %%: %.3f N RMS against the truth over 0 to 5.9 N, threshold "
      "within %.3f N\n",
      rms, worst_threshold);
  EXPECT_LT(rms, 0.06);
  EXPECT_LT(worst_threshold, 0.05);
}

TEST(Pressure, IsMonotoneAndItsInverseGivesItBack) {
  const auto found = weighed(weights, pressed(weights, 0.03));
  ASSERT_TRUE(found) << found.error().reason;
  double before = -1;
  for (int i = 0; i <= 1000; ++i) {
    const double p = i / 1000.0, f = force_n(found->value, Fraction(p));
    EXPECT_GE(f, before);
    before = f;
    EXPECT_NEAR(force_n(found->value, pressure_at(found->value, f)), f, 1e-9) << p;
  }
  EXPECT_EQ(pressure_at(found->value, 0).value, 0);
  EXPECT_EQ(pressure_at(found->value, 100).value, 1);
  EXPECT_EQ(force_n(found->value, Fraction(2)), force_n(found->value, Fraction(1)));
}

TEST(Pressure, RepeatedWeightsAverage) {
  std::vector<double> thrice;
  for (int round = 0; round < 3; ++round) thrice.insert(thrice.end(), weights.begin(), weights.end());
  const auto found = weighed(thrice, pressed(thrice, 0.03));
  ASSERT_TRUE(found) << found.error().reason;
  for (const double p : {0.2, 0.5, 0.8})
    EXPECT_NEAR(force_n(found->value, Fraction(p)), truly_n(p), 0.05 * truly_n(p));
}

TEST(Pressure, ByTheTimesOfTheScaleWhatWasNotFeltCounts) {
  std::vector<double> grams{5, 9};
  grams.insert(grams.end(), weights.begin(), weights.end());
  const auto samples = pressed(grams);
  std::vector<Weighing> weighings;
  for (std::size_t i = 0; i < grams.size(); ++i)
    weighings.push_back({grams[i], samples[50 * i + 25].time.host});
  PressureProcedure procedure(weighings);
  for (const PenSample& s : samples) procedure.add(s);
  const auto found = procedure.finish();
  ASSERT_TRUE(found) << found.error().reason;
  EXPECT_GE(found->value.force_n.front(), n_per_g * 9);
  EXPECT_LE(found->value.force_n.front(), n_per_g * 15);
}

TEST(Pressure, ReadsBack) {
  const auto found = weighed(weights, pressed(weights));
  ASSERT_TRUE(found);
  const auto read = pressure_curve_from(to_fields(found->value));
  ASSERT_TRUE(read);
  EXPECT_EQ(force_n(*read, Fraction(0.37)), force_n(found->value, Fraction(0.37)));
  EXPECT_EQ(read->saturation_n, found->value.saturation_n);
  EXPECT_FALSE(
      pressure_curve_from({{"pressure", std::vector{0.0, 1.0}}, {"force_n", std::vector{1.0, 0.5}}}));
}

TEST(PressureWarns, WhereTheRangeWasNotPressed) {
  const std::vector<double> middle{150, 180, 210, 250, 280, 320, 360};
  const auto found = weighed(middle, pressed(middle));
  ASSERT_TRUE(found) << found.error().reason;
  EXPECT_FALSE(found->value.saturation_n);
  ASSERT_EQ(found->report.warnings.size(), 2U);
  EXPECT_NE(found->report.warnings[0].find("no press was hard enough"), std::string::npos);
  EXPECT_NE(found->report.warnings[1].find("more lightly"), std::string::npos);
}

void expect_refused(const std::vector<double>& grams, const std::vector<PenSample>& samples,
                    const std::string& cause) {
  const auto found = weighed(grams, samples);
  ASSERT_FALSE(found) << "accepted, where it should name: " << cause;
  EXPECT_NE(found.error().reason.find(cause), std::string::npos) << found.error().reason;
}

TEST(PressureRefuses, ByTheCause) {
  const auto samples = pressed(weights);
  std::vector<double> other{weights.rbegin(), weights.rend()};
  expect_refused(other, samples, "reverse order");
  other = weights;
  std::swap(other[2], other[9]);
  expect_refused(other, samples, "in the order of the presses?");
  other = weights;
  other.pop_back();
  expect_refused(other, samples, "14 presses for 13 weights");
  expect_refused({50, 100, 200, 300}, pressed({50, 100, 200, 300}), "only 4 levels");
  other = weights;
  for (double& g : other) g *= 1e-3;
  expect_refused(other, samples, "give grams");
  other[0] = std::nan("");
  expect_refused(other, samples, "no number");
  auto frozen = samples;
  for (PenSample& s : frozen) s.pressure = Fraction(0.4);
  expect_refused(weights, frozen, "frozen");
  expect_refused({}, {}, "only 0 levels");
}

}  // namespace
}  // namespace fude
